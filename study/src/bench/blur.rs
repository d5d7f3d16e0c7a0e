//! `subsurf-study bench blur`: what the blurs of a separable kernel cost on a screen, against plain copies that move as many bytes.

use std::path::PathBuf;

use serde_json::{Value, json};
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::Kernel;
use subsurf_encoder::synthetic::unit;
use subsurf_runtime::{Backend, Gpu, KernelScreen, Load, PatchLight, RuntimeOptions};
use subsurf_viewer::{DrawnMaterial, parse, read, stem};

use super::devices::to_compare;
use super::timing::{Clock, median};

/// Time the blurs of kernels over a whole screen, against plain full-screen copies that move as many bytes.
///
/// A plane of the material covers the screen, under noise. A term takes two passes, which read 8, write 8, read 16 and write 8 bytes a
/// texel if nothing is read twice; a copy reads 8 and writes 8. Blurs and copies take turns, each as many times as the median's run
/// has, in one submission that is waited for. (Published: 0.489 ms for 1920 × 1080 pixels on a Radeon HD 7970; Jimenez et al. 2015.)
#[derive(clap::Args)]
pub(crate) struct Args {
    /// Kernel files
    #[arg(required = true)]
    files: Vec<PathBuf>,
    /// Pixels of the screen
    #[arg(long, default_value = "1920x1080", value_name = "WxH")]
    size: Size,
    /// Pixels that a mm covers: 5 for a head that is as high as the screen
    #[arg(long, default_value_t = 5.0, value_name = "N")]
    pixels_per_mm: f32,
    /// Runs of each, after one that does not count
    #[arg(long, default_value_t = 9)]
    runs: usize,
    /// Blurs of a run
    #[arg(long, default_value_t = 4)]
    blurs: usize,
    /// Leave all taps on the axes
    #[arg(long)]
    straight: bool,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.runs == 0 || args.blurs == 0 || args.size.0.contains(&0) {
        return Err(bad_request("--runs, --blurs and --size must be positive"));
    }
    if !(args.pixels_per_mm.is_finite() && args.pixels_per_mm > 0.0) {
        return Err(bad_request("--pixels-per-mm must be positive"));
    }
    let mut all = Vec::new();
    for (backend, gpu) in to_compare() {
        for file in &args.files {
            let bytes = read(file)?;
            let DrawnMaterial::Kernel(kernel) = parse(file, &bytes)? else {
                return Err(bad_request(format!("{}: no kernel; `subsurf kernel` makes one", file.display())));
            };
            all.push(measure(&gpu, backend, &stem(file), &kernel, args)?);
        }
    }
    if args.json {
        outln!("{:#}", Value::Array(all));
    }
    Ok(())
}

fn measure(gpu: &Gpu, backend: Backend, name: &str, kernel: &Kernel<'_>, args: &Args) -> anyhow::Result<Value> {
    let size = args.size.0;
    let noise: Vec<[f32; 3]> = (0..size[0] * size[1]).map(|pixel| [0, 1, 2].map(|c| unit(3 * pixel + c))).collect();
    let light = PatchLight::upload(gpu, size, &noise)?;
    let material = Load::kernel(gpu, kernel)?.finish()?;
    let is_jittered = RuntimeOptions::default().jittered_taps && !args.straight;
    let screen = KernelScreen::new(gpu, &material, &light, size, args.pixels_per_mm, is_jittered)?;
    let mut times = [Vec::new(), Vec::new()];
    for run in 0..=args.runs {
        let mut clock = Clock::new();
        screen.blur(gpu, args.blurs)?;
        gpu.finish()?;
        let blurred = clock.lap();
        screen.copy(gpu, args.blurs)?;
        gpu.finish()?;
        let copied = clock.lap();
        // Drivers compile at the first one.
        if run > 0 {
            #[allow(clippy::cast_precision_loss, reason = "a few")]
            let of_one = |us: f64| 1e-3 * us / args.blurs as f64;
            times[0].push(of_one(blurred));
            times[1].push(of_one(copied));
        }
    }
    let [blur_ms, copy_ms] = times.map(|times| median(&times));
    #[allow(clippy::cast_precision_loss, reason = "megabytes")]
    let copies = screen.blur_bytes() as f64 / screen.copy_bytes() as f64;
    let ratio = blur_ms / (copies * copy_ms);
    let header = kernel.header();
    outln!(
        "{backend}, {name}: {} terms, {} taps, {}x{}: blurs {blur_ms:.2} ms, a copy {copy_ms:.2} ms; {ratio:.1} × the {copies} \
         copies that move as many bytes",
        header.terms,
        header.taps,
        size[0],
        size[1],
    );
    Ok(json!({
        "backend": backend.to_string(), "file": name, "terms": header.terms, "taps": header.taps, "size": size,
        "jittered": is_jittered, "blur_ms": blur_ms, "copy_ms": copy_ms, "blur_bytes": screen.blur_bytes(),
        "copy_bytes": screen.copy_bytes(), "ratio": ratio,
    }))
}
