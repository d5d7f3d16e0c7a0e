//! `subsurf-study bench basis`: how close separable bases come to the gather of their files, flat and drawn by a device.

use std::path::PathBuf;
use std::time::Instant;

use serde_json::{Value, json};
use subsurf_cli::info::parse;
use subsurf_cli::outln;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::container::ENTRY_BYTES;
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, fit_basis, with_basis};
use subsurf_encoder::metrics::bssrdf::Light;
use subsurf_encoder::metrics::psnr_db;
use subsurf_runtime::{Backend, Gpu, Load, PatchLight, SeparableMaterial, SeparableRenderer};
use subsurf_shaders::separable::ProjectedBasis;
use subsurf_shaders::{Rgb, cpu};
use subsurf_viewer::{read, stem};

use super::devices::to_compare;

/// Compare separable bases with the gather of the same file: what the fit starts from, and what it ends at.
///
/// PSNR in dB under uniform, disc and line light, peak the largest exitance of the gather; of flat patches, by the CPU in single
/// precision and by every device there is, in half floats.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// .subsurf files; a basis that they have is not looked at
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

/// Numbers L of maps and A of Gaussians.
const SIZES: [[usize; 2]; 4] = [[1, 3], [1, 4], [2, 3], [2, 4]];

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let gpus = to_compare();
    let mut all = Vec::new();
    for path in &args.files {
        let bytes = read(path)?;
        let material = parse(path, &bytes)?;
        let lights = lights(&material);
        outln!("{}", path.display());
        for [terms, gaussians] in SIZES {
            for steps in [0, BasisOptions::default().steps] {
                let choice = BasisChoice::Size(BasisSize { terms, gaussians });
                let begin = Instant::now();
                let fit = fit_basis(&material, &BasisOptions { choice, steps }, &())?;
                let fit_s = begin.elapsed().as_secs_f64();
                let kind = if steps == 0 { "start" } else { "joint" };
                let section_bytes = ENTRY_BYTES + fit.to_bytes().len();
                let with = with_basis(&bytes, &fit)?;
                let material = Bssrdf::parse(&with)?;
                let begin = Instant::now();
                let basis = ProjectedBasis::of(&material).expect("a file with a basis");
                std::hint::black_box(basis.albedo());
                let projection_ms = 1e3 * begin.elapsed().as_secs_f64();
                outln!(
                    "  L = {terms}, A = {gaussians}, {kind}: fitted in {fit_s:.1} s, {section_bytes} bytes more, projected in \
                     {projection_ms:.1} ms"
                );
                let by_cpu = ("CPU, single precision".to_owned(), psnr_of(&lights, |light| Ok(basis.exitance(light)))?);
                let by_gpu = |(backend, gpu): &(Backend, Gpu)| {
                    let uploaded = Load::separable(gpu, &material, basis.numbers())?.finish()?;
                    Ok((backend.to_string(), psnr_of(&lights, |light| drawn(gpu, &uploaded, light))?))
                };
                let by_gpus: Vec<_> = gpus.iter().map(by_gpu).collect::<anyhow::Result<_>>()?;
                for (by, db) in std::iter::once(by_cpu).chain(by_gpus) {
                    outln!("    {by:22} {:.1} / {:.1} / {:.1} dB", db[0], db[1], db[2]);
                    all.push(json!({
                        "file": stem(path), "terms": terms, "gaussians": gaussians, "fit": kind, "by": by, "psnr_db": db,
                        "fit_s": fit_s, "projection_ms": projection_ms, "bytes": section_bytes,
                        "sigmas_px": fit.sigmas,
                    }));
                }
            }
        }
    }
    if args.json {
        outln!("{:#}", Value::Array(all));
    }
    Ok(())
}

/// Irradiance of every light, and what the gather makes of it.
fn lights(material: &Bssrdf<'_>) -> Vec<(Vec<Rgb>, Vec<Rgb>)> {
    let size = [material.header().width, material.header().height];
    let of = |light: Light| {
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x as usize, y as usize]));
        let irradiance: Vec<Rgb> =
            pixels.map(|pixel| [light.irradiance(pixel, size.map(|side| side as usize)); 3]).collect();
        let expected = cpu::gather(material, &irradiance, [0, 0], size);
        (irradiance, expected)
    };
    Light::ALL.map(of).to_vec()
}

/// PSNR of each light.
fn psnr_of(
    lights: &[(Vec<Rgb>, Vec<Rgb>)],
    exitance: impl Fn(&[Rgb]) -> anyhow::Result<Vec<Rgb>>,
) -> anyhow::Result<Vec<f64>> {
    let of = |(irradiance, expected): &(Vec<Rgb>, Vec<Rgb>)| {
        let found = exitance(irradiance)?;
        let largest = expected.iter().flatten().copied().fold(1e-30, f32::max);
        let normalised = |image: &[Rgb]| -> Vec<[f64; 3]> {
            image.iter().map(|rgb| rgb.map(|value| f64::from(value / largest))).collect()
        };
        Ok(psnr_db(&normalised(expected), &normalised(&found)))
    };
    lights.iter().map(of).collect()
}

/// Exitance of the patch as the device draws it.
fn drawn(gpu: &Gpu, material: &SeparableMaterial, irradiance: &[Rgb]) -> anyhow::Result<Vec<Rgb>> {
    let light = PatchLight::upload(gpu, [material.header().width, material.header().height], irradiance)?;
    let renderer = SeparableRenderer::new(gpu, material.terms())?;
    let patch = renderer.prepare(gpu, material, &light)?;
    Ok(renderer.draw(gpu, &patch)?.read(gpu)?)
}
