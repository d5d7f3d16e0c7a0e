//! `subsurf-study bench patch`: what the separable path costs on a flat patch, against the gather and against one kernel for all.

use std::time::Instant;

use serde_json::{Value, json};
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis};
use subsurf_encoder::synthetic::Shape;
use subsurf_runtime::{
    Backend, BssrdfPlanes, Gpu, HomogeneousRenderer, Load, PatchLight, PatchRenderer, Region, SeparableRenderer,
    layout_of,
};
use subsurf_shaders::mean_kernel;
use subsurf_viewer::{Scattering, numbers};

use super::devices::to_compare;
use super::timing::median;

/// Time flat patches: the gather, the separable path, and a separable pass with one kernel for the whole patch.
///
/// The one kernel has a tap for every pixel of the window's diameter, about as many to an axis as all stages of the
/// separable path together. Materials are synthetic: for timing their numbers do not matter.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Sides of the patches, in pixels
    #[arg(long = "side", default_values_t = [96, 229, 512])]
    sides: Vec<u32>,
    /// Diameter of the window in pixels, odd
    #[arg(long, default_value_t = 25)]
    window: u16,
    /// Frames of each, after one that does not count
    #[arg(long, default_value_t = 15)]
    frames: usize,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.frames == 0 || args.window.is_multiple_of(2) || args.window > 127 {
        return Err(bad_request("--frames must be positive and --window odd, at most 127"));
    }
    if args.sides.iter().any(|side| !(8..=2_048).contains(side)) {
        return Err(bad_request("--side must be between 8 and 2048"));
    }
    let mut all = Vec::new();
    for (backend, gpu) in to_compare() {
        outln!("{backend}");
        for &side in &args.sides {
            all.push(measure(&gpu, backend, side, args)?);
        }
    }
    if args.json {
        outln!("{:#}", Value::Array(all));
    }
    Ok(())
}

fn measure(gpu: &Gpu, backend: Backend, side: u32, args: &Args) -> anyhow::Result<Value> {
    let radius = args.window / 2;
    let shape =
        Shape { size: [side; 2], radius, samples: radius + 1, base_materials: 128, addressing: Addressing::Clamp };
    // Usual numbers, from the start of the fit: only their count matters.
    let size = BasisSize { terms: 2, gaussians: 4 };
    let options = BasisOptions { choice: BasisChoice::Size(size), steps: 0 };
    let file = add_basis(&shape.bmpp(), &options, &())?;
    let material = Bssrdf::parse(&file)?;
    let light = PatchLight::upload(gpu, [side; 2], &vec![[1.0; 3]; (side * side) as usize])?;

    let uploaded = BssrdfPlanes::upload(gpu, &material)?;
    let renderer = PatchRenderer::new(gpu, layout_of(&material))?;
    let whole = Region { origin: [0, 0], size: [side; 2] };
    // A gather takes long enough to be timed a few times only.
    let gather = times(gpu, args.frames.min(3), || renderer.gather(gpu, &uploaded, &light, whole).map(|_| ()))?;

    let numbers = numbers(&material, Scattering::Separable)?;
    let uploaded = Load::separable(gpu, &material, &numbers)?.finish()?;
    let renderer = SeparableRenderer::new(gpu, uploaded.terms())?;
    let patch = renderer.prepare(gpu, &uploaded, &light)?;
    let separable = times(gpu, args.frames, || renderer.draw(gpu, &patch).map(|_| ()))?;

    let kernel = mean_kernel(&material);
    let renderer = HomogeneousRenderer::new(gpu)?;
    let patch = renderer.prepare(gpu, material.header(), &kernel, &light)?;
    let homogeneous = times(gpu, args.frames, || renderer.draw(gpu, &patch).map(|_| ()))?;

    let taps: i32 = numbers.cascade().stages().iter().map(|stage| 2 * stage.taps + 1).sum();
    let [gather, separable, homogeneous] = [gather, separable, homogeneous].map(|times| median(&times));
    outln!(
        "  {side}x{side}: gather {gather:.1} ms, separable {separable:.2} ms ({taps} taps an axis), one kernel \
         {homogeneous:.2} ms ({} taps): {:.1} × faster than the gather, {:.2} × the one kernel",
        2 * kernel.len() - 1,
        gather / separable,
        separable / homogeneous,
    );
    Ok(json!({
        "backend": backend.to_string(), "side": side, "window": args.window, "gather_ms": gather,
        "separable_ms": separable, "separable_taps": taps, "homogeneous_ms": homogeneous,
        "homogeneous_taps": 2 * kernel.len() - 1,
    }))
}

/// Milliseconds until the device is through, after a first time that does not count.
fn times(gpu: &Gpu, count: usize, work: impl Fn() -> subsurf_runtime::Result<()>) -> anyhow::Result<Vec<f64>> {
    work()?;
    gpu.finish()?;
    let mut all = Vec::new();
    for _ in 0..count {
        let begin = Instant::now();
        work()?;
        gpu.finish()?;
        all.push(1e3 * begin.elapsed().as_secs_f64());
    }
    Ok(all)
}
