//! The decoder as firmware would link it: no std, no allocator, its own panic handler.
//!
//! If anything pulls in std, the panic handler is there twice; if anything pulls in alloc, a global allocator is
//! missing: either way this does not build. `check` then proves that no panic is reachable from either entry point.
#![no_std]

use core::panic::PanicInfo;
use subsurf_decoder::bssrdf::{BssrdfModel, ProfileTable};
use subsurf_decoder::btf::factored::ExpansionBuffers;
use subsurf_decoder::container::Crc;
use subsurf_decoder::push::{Piece, PushReader};
use subsurf_decoder::transfer::LightWeights;
use subsurf_decoder::{Bssrdf, Content, Evaluate, FactoredBtf, File, Kernel, NestedBtf, ReadError, Transfer};

#[panic_handler]
fn panic(_: &PanicInfo<'_>) -> ! {
    loop {}
}

/// What a C caller hands in and gets back.
#[repr(C)]
pub struct Probe {
    /// Two pixels, [column, row] each.
    x_i: [i32; 2],
    x_o: [i32; 2],
    /// Distance in mm.
    r_mm: f32,
    /// Whether to compare CRCs.
    check_crc: bool,
    /// Results: Rd between the pixels, the albedo of the first, its profile at `r_mm`.
    rd: [f32; 3],
    albedo: [f32; 3],
    log_profile: [f32; 3],
    /// Sum over all planes, so that their accessors are linked.
    sum: f32,
    /// Material, mipmap level and coordinates of a texel of a BTF.
    material: usize,
    level: u8,
    texel: [i32; 2],
    /// Unit vectors towards light and eye, and two random numbers.
    light: [f32; 3],
    view: [f32; 3],
    random: [f32; 2],
    /// Results: the texel's value, linear too, its albedo, a light that was drawn and both lights' densities.
    value: [f32; 3],
    linear: [f32; 3],
    btf_albedo: [f32; 3],
    drawn: [f32; 3],
    pdfs: [f32; 2],
    /// Room for the base scattering profiles of a small window.
    profiles: ProfileTable<512>,
    /// Room for a factored BTF that is small.
    table: [i8; 4096],
    words: [i16; 4096],
    scratch: [f32; 512],
    /// Room for the weights of a transfer of few lights.
    triangle: [f32; 2048],
    weights: [f32; 32],
}

/// Parses a file of any family and calls every accessor; false if the file was refused.
///
/// # Safety
/// `file` must point to `len` readable bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_probe(file: *const u8, len: usize, probe: &mut Probe) -> bool {
    // SAFETY: the caller promises `len` readable bytes at `file`.
    let file = unsafe { core::slice::from_raw_parts(file, len) };
    decode(file, probe).is_ok()
}

fn decode(file: &[u8], probe: &mut Probe) -> Result<(), ReadError> {
    #[cfg(feature = "control")]
    {
        probe.sum = f32::from(file[probe.x_i[0] as usize]);
    }
    let crc = if probe.check_crc { Crc::Check } else { Crc::Skip };
    match File::parse_with(file, crc)?.content() {
        Content::Bssrdf(material) => evaluate(&material, probe),
        Content::NestedBtf(btf) => look_at(&btf, probe),
        Content::FactoredBtf(btf) => expand(&btf, probe),
        Content::Kernel(kernel) => sum_up(&kernel, probe),
        Content::Transfer(transfer) => relight(&transfer, probe),
        _ => {}
    }
    Ok(())
}

/// Reads a file in chunks of 64 bytes, and adds up what its rows begin with; false if it was refused.
///
/// # Safety
/// `file` must point to `len` readable bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_push_probe(file: *const u8, len: usize, probe: &mut Probe) -> bool {
    // SAFETY: the caller promises `len` readable bytes at `file`.
    let file = unsafe { core::slice::from_raw_parts(file, len) };
    push(file, probe).is_ok()
}

fn push(file: &[u8], probe: &mut Probe) -> Result<(), ReadError> {
    let mut reader = PushReader::<2048>::with_crc(if probe.check_crc { Crc::Check } else { Crc::Skip });
    for chunk in file.chunks(64) {
        reader.push(chunk, |piece| match piece {
            Piece::Row(row) => probe.sum += row.bytes.first().map_or(0.0, |byte| f32::from(*byte)),
            Piece::Material(material) => probe.sum += material.name().len() as f32,
            _ => {}
        })?;
    }
    reader.finish()
}

/// Every accessor of a BSSRDF.
fn evaluate(material: &Bssrdf<'_>, probe: &mut Probe) {
    probe.rd = material.rd(probe.x_i, probe.x_o);
    probe.albedo = material.albedo(probe.x_i);
    if probe.profiles.expand(material)
        && let BssrdfModel::BaseMaterials(planes) = material.model()
    {
        let [i, o] = [probe.x_i, probe.x_o].map(|[x, y]| planes.mixtures.at(x as usize, y as usize));
        probe.sum += probe.profiles.rd(&i, &o, probe.x_i[0], probe.x_o[1])[0];
    }
    if let Some(knot) = material.knot(probe.r_mm) {
        probe.log_profile = material.profile(probe.x_i).at(knot);
    }
    probe.sum += match material.model() {
        BssrdfModel::BaseMaterials(planes) => {
            let mixture = planes.mixtures.at(probe.x_i[0] as usize, probe.x_i[1] as usize);
            planes.profiles.rgb_at(probe.x_o[0] as usize).iter().chain(&mixture.ratios).sum::<f32>()
        }
        BssrdfModel::PerPixel(planes) => planes.profiles.iter().sum::<f32>(),
    };
}

/// Every accessor of a nested BTF.
fn look_at(btf: &NestedBtf<'_>, probe: &mut Probe) {
    probe.sum =
        btf.materials().map(|material| material.name().len() as f32 + material.size(probe.level)[0] as f32).sum();
    let Some(texel) = btf.texel(probe.material, probe.level, probe.texel) else { return };
    probe.value = btf.eval(texel, probe.light, probe.view);
    probe.linear = btf.header().encoding.linear(probe.value);
    probe.sum += btf.header().encoding.encode(probe.linear)[0];
    let view = btf.grid().view(probe.view);
    let prepared = btf.eval_for(texel, probe.light, &view);
    probe.sum += prepared[0] + f32::from(btf.codebooks().sizes().chroma.is_relative);
    probe.btf_albedo = btf.albedo(texel, probe.view);
    let sample = btf.sample(texel, probe.view, probe.random);
    probe.drawn = sample.light;
    let sampler = btf.sampler(texel, &view);
    probe.pdfs = [sampler.sample(probe.random).pdf, sampler.pdf(probe.light) + btf.pdf(texel, probe.drawn, probe.view)];
}

/// A factored BTF expanded, and one value of it.
fn expand(btf: &FactoredBtf<'_>, probe: &mut Probe) {
    let Probe { table, words, scratch, .. } = probe;
    let Some(expanded) = btf.expand(ExpansionBuffers { table, words, scratch }) else { return };
    let Some(texel) = expanded.catalog().texel(probe.material, probe.level, probe.texel) else { return };
    let view = expanded.catalog().grid().view(probe.view);
    probe.value = expanded.eval(texel, probe.light, probe.view);
    probe.linear = expanded.eval_for(texel, probe.light, &view);
}

/// Every accessor of a kernel.
fn sum_up(kernel: &Kernel<'_>, probe: &mut Probe) {
    probe.rd = kernel.rd(probe.r_mm);
    probe.albedo = kernel.tail_at(probe.r_mm);
    probe.log_profile = kernel.weight(probe.material, usize::from(probe.level));
    probe.sum = kernel.sign(probe.material)[0] + kernel.energy()[0] + kernel.offsets().iter().sum::<f32>();
    probe.sum += kernel.two_gaussians().map_or(0.0, |gaussians| gaussians.weight[0]);
}

/// A transfer for one light, and all that it says.
fn relight(transfer: &Transfer<'_>, probe: &mut Probe) {
    let Probe { triangle, weights, scratch, .. } = probe;
    probe.sum =
        transfer.lights().iter().chain(transfer.tail().iter()).sum::<f32>() + transfer.vertex_codes().len() as f32;
    if let Some(between) = LightWeights::new(transfer.lights(), triangle) {
        between.at(probe.light, weights);
    }
    transfer.light_table(weights, scratch);
    transfer.exitance(scratch, usize::from(probe.level), &mut probe.value);
}
