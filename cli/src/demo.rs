//! `subsurf demo`: everything once, and a folder to look at.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::json;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::bssrdf::basis::{BasisOptions, add_basis};
use subsurf_encoder::bssrdf::{Method, Options, encode};
use subsurf_encoder::capture::{Capture, Overrides, Scalar};
use subsurf_encoder::metrics::bssrdf::{Judgement, Light, judge};
use subsurf_encoder::simulate::diffusion::{self, BuiltinMaterial, Finish, Request};
use subsurf_encoder::write_bytes;
use subsurf_runtime::{Backend, BssrdfPlanes, Gpu, PatchLight, PatchRenderer, Region, layout_of};
use subsurf_scene::torus;
use subsurf_shaders::cpu;
use subsurf_viewer::{MappingChoice, RenderRequest, Scattering, human};

use crate::compare::{self, db};
use crate::devices;
use crate::outln;
use crate::picture::{montage, triptych, write_picture};
use crate::program::failure::bad_request;
use crate::program::progress::Bars;
use crate::render::{draw_mesh, draw_patch, patch_irradiance};

/// Simulate, encode, judge and draw one material, and leave pictures and a table in a folder.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The folder
    #[arg(long, default_value = "demo-out", value_name = "DIR")]
    dir: PathBuf,
}

const SIZE: usize = 56;
const WINDOW: u32 = 25;
const BASE_MATERIALS: usize = 48;
const PITCH_MM: f64 = 0.5;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let dir = &args.dir;
    std::fs::create_dir_all(dir)
        .map_err(|error| bad_request(format!("{}: cannot make the folder: {error}", dir.display())))?;
    let path = |name: &str| dir.join(name);

    outln!("1. Simulating a capture of a synthetic onyx, {SIZE} × {SIZE} pixels, window {WINDOW} (under a minute) ..");
    let start = Instant::now();
    let map = BuiltinMaterial::Onyx.map([SIZE; 2], Addressing::Repeat, 1);
    let request = Request {
        method: diffusion::Method::Diffusion,
        map: &map,
        source: json!({ "scene": BuiltinMaterial::Onyx.name() }),
        addressing: Addressing::Repeat,
        pitch_mm: PITCH_MM,
        window: WINDOW,
        thickness_mm: 20.0,
        eta: 1.5,
        refine: 1.0,
        finish: Finish::default(),
        seed: 1,
        scalar: Scalar::F32,
    };
    request.write(&path("onyx.npy"), &Bars::new())?;
    outln!("   {:.1} s", start.elapsed().as_secs_f64());

    outln!("2. Encoding it: per-pixel profiles, and 2-BMPP with {BASE_MATERIALS} base materials ..");
    let capture = Capture::open(&path("onyx.npy"), &Overrides::default())?;
    let mut judgements = Vec::new();
    let mut files = Vec::new();
    for (method, name) in [(Method::Song2009, "onyx-profiles.subsurf"), (Method::Direct, "onyx.subsurf")] {
        let start = Instant::now();
        let options = Options { method, base_materials: BASE_MATERIALS, ..Options::default() };
        let encoded = encode(&capture, None, &options, &Bars::new())?;
        // What is looked at on meshes gets a separable basis, too.
        let bytes = match method {
            Method::Direct => add_basis(&encoded.bytes, &BasisOptions::default(), &Bars::new())?,
            _ => encoded.bytes,
        };
        write_bytes(&path(name), &bytes)?;
        outln!("   {name}: {} in {:.1} s", human(bytes.len() as u64), start.elapsed().as_secs_f64());
        let material = Bssrdf::parse(&bytes)?;
        judgements.push(judge(&capture, &material, bytes.len() as u64, &Bars::new())?);
        files.push(bytes);
    }
    let material = Bssrdf::parse(&files[1])?;
    compare::print(&judgements[1]);
    let rows: Vec<_> = judgements[1].comparison.lit.iter().map(|relit| triptych(relit, SIZE)).collect();
    write_picture(&path("comparison.png"), &montage(&rows))?;

    outln!("3. Drawing it ..");
    let drawn = draw(dir, &material)?;

    let table = format!(
        "{}\nDrawn by: {}\n{}",
        quality_table(&capture, &judgements),
        if drawn.devices.is_empty() { devices::name(None) } else { drawn.devices.join("; ") },
        drawn.agreement,
    );
    outln!("\n{table}");
    write_bytes(&path("table.md"), table.as_bytes())?;

    outln!("Look at these, in {}:", std::path::absolute(dir)?.display());
    outln!("  comparison.png   original, 2-BMPP, and ten times their difference, under three lights");
    outln!("  patch.png        the patch lit by a disc, from the file");
    outln!("  mesh.png         a torus made of the material");
    outln!("  table.md         the table above");
    outln!("  onyx.npy, onyx.subsurf   the capture and the file, to try the other commands on");
    Ok(())
}

struct Drawn {
    devices: Vec<String>,
    /// How far the devices are from the CPU.
    agreement: String,
}

/// Draws patch and torus by every backend that opens, or by the CPU, and compares the devices with the CPU.
fn draw(dir: &Path, material: &Bssrdf<'_>) -> anyhow::Result<Drawn> {
    let gpus: Vec<Gpu> = Backend::ALL.into_iter().filter_map(|backend| Gpu::open(backend).ok()).collect();
    if gpus.is_empty() {
        outln!("   no device found: the CPU draws");
    }
    let header = material.header();
    let whole = Region { origin: [0, 0], size: [header.width, header.height] };
    let irradiance = patch_irradiance(material, Light::Disc);
    let expected = cpu::gather(material, &irradiance, whole.origin, whole.size);
    let mut agreement = String::new();
    let mut devices = Vec::new();
    for gpu in &gpus {
        let uploaded = BssrdfPlanes::upload(gpu, material)?;
        let renderer = PatchRenderer::new(gpu, layout_of(material))?;
        let light = PatchLight::upload(gpu, [header.width, header.height], &irradiance)?;
        let found = renderer.gather(gpu, &uploaded, &light, whole)?.read(gpu)?;
        let largest = expected.iter().flatten().copied().fold(0.0, f32::max);
        let differences = found.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs() / largest);
        let worst = differences.fold(0.0, f32::max);
        let name = devices::name(Some(gpu));
        let line = format!("{name}: at most {worst:.1e} of the brightest value from the CPU's exitance");
        outln!("   {line}");
        // Writing to a string cannot fail.
        let _ = writeln!(agreement, "- {line}");
        devices.push(name);
    }
    let gpu = gpus.first();
    let patch = draw_patch(gpu, material, Scattering::Gather, Light::Disc, [512, 512], None)?;
    write_picture(&dir.join("patch.png"), &patch.picture)?;
    let mesh = draw_mesh(
        gpu,
        material,
        &torus(18.0, 8.0, 64),
        MappingChoice::Auto,
        Scattering::Gather,
        &RenderRequest::usual([800, 600]),
    )?;
    write_picture(&dir.join("mesh.png"), &mesh.picture)?;
    Ok(Drawn { devices, agreement })
}

/// How good and how large: the original, per-pixel profiles, 2-BMPP.
fn quality_table(capture: &Capture, judgements: &[Judgement]) -> String {
    let mut out = String::from(
        "| | bytes | relative error | PSNR uniform / disc / line (dB) | SSIM uniform |\n|---|---:|---:|---:|---:|\n",
    );
    // Writing to a string cannot fail.
    let _ = writeln!(out, "| capture | {} | | | |", human(capture.file_bytes()));
    for (name, judgement) in ["per-pixel profiles", "2-BMPP"].iter().zip(judgements) {
        let [uniform, disc, line] = judgement.psnr_db.map(db);
        let _ = writeln!(
            out,
            "| {name} | {} | {:.4} | {uniform} / {disc} / {line} | {} |",
            human(judgement.bytes),
            judgement.relative_error_mean,
            judgement.ssim[0].map_or("-".to_owned(), |ssim| format!("{ssim:.4}")),
        );
    }
    out
}
