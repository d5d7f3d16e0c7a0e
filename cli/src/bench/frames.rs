//! `subsurf bench frames`: how long frames take, pass by pass.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use glam::{Quat, Vec3};
use serde_json::{Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::Progress as _;
use subsurf_encoder::synthetic::per_pixel_of;
use subsurf_runtime::scene::{LightShape, Mesh, Scene, relief};
use subsurf_runtime::{Backend, Gpu, RuntimeOptions};

use super::timing::{median, quantile};
use crate::failure::bad_request;
use crate::info::{parse, read_file};
use crate::memory::human;
use crate::mesh::{Up, fitted, load, stem};
use crate::options::Size;
use crate::progress::Bars;
use crate::render::{Ingredients, MappingArg, PathArg, Prepared, Ready, Shot, choose_mapping};
use crate::say::say;

/// Time frames of meshes of 5 to 871 thousand triangles, pass by pass, on every device there is.
///
/// The light turns a little from frame to frame, so that everything is computed anew. Times are wall-clock milliseconds
/// until the device is through; compare those of one run.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The .subsurf file
    file: PathBuf,
    /// Meshes: files, or names of shapes; if none are given, a sphere with bumps in four sizes
    #[arg(long = "mesh", value_name = "FILE|SHAPE")]
    meshes: Vec<PathBuf>,
    /// Pixels of the picture
    #[arg(long, default_value = "1280x720", value_name = "WxH")]
    size: Size,
    /// Frames of each, after one that does not count
    #[arg(long, default_value_t = 9)]
    frames: usize,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

/// Rings of `relief` that make the triangles of the paper's meshes and fewer: 4 rings².
const RELIEFS: [u16; 4] = [35, 79, 158, 467];
const EXTENT_MM: f32 = 60.0;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.frames == 0 {
        return Err(bad_request("--frames is 0; at least one is needed for a time"));
    }
    let bytes = read_file(&args.file)?;
    let material = parse(&args.file, &bytes)?;
    let profiles = per_pixel_of(&material);
    let profiles = Bssrdf::parse(&profiles)?;
    let meshes: Vec<(String, Mesh)> = match &args.meshes[..] {
        [] => RELIEFS.iter().map(|&rings| bumpy_sphere(rings)).collect::<anyhow::Result<_>>()?,
        paths => paths.iter().map(|path| named(path)).collect::<anyhow::Result<_>>()?,
    };
    let ways = [
        ("splat", &material, PathArg::Splat),
        ("splat, per-pixel profiles", &profiles, PathArg::Splat),
        ("separable", &material, PathArg::Separable),
        ("homogeneous", &material, PathArg::Homogeneous),
    ];
    let gpus = devices();
    let mut all = Vec::new();
    for (name, mesh) in &meshes {
        say!("{name}, {} triangles, {}x{} pixels", mesh.triangles.len(), args.size.0[0], args.size.0[1]);
        let mapping = choose_mapping(mesh, MappingArg::Auto, &material)?;
        let scene = Shot::usual(args.size.0).scene(mesh);
        let mut sky = None;
        for (way, material, path) in ways {
            let ingredients = Ingredients::compute(material, mesh, mapping, &scene, path, sky.clone())?;
            sky = sky.or(ingredients.sky().cloned());
            for (backend, gpu) in &gpus {
                let times = measure(gpu, &ingredients, material, mesh, args.size.0, args.frames)?;
                say!("  {backend:10} {way:26} {}", times.line());
                all.push(times.json(*backend, name, way));
            }
        }
    }
    if args.json {
        say!("{:#}", Value::Array(all));
    }
    Ok(())
}

fn bumpy_sphere(rings: u16) -> anyhow::Result<(String, Mesh)> {
    Ok(("bumpy sphere".to_owned(), fitted(relief(20.0, 8, rings), EXTENT_MM)?))
}

/// A mesh and what to call it.
pub(super) fn named(path: &Path) -> anyhow::Result<(String, Mesh)> {
    Ok((stem(path), load(path, EXTENT_MM, Up::Y)?))
}

/// All devices, and what they are.
pub(super) fn devices() -> Vec<(Backend, Gpu)> {
    let mut gpus = Vec::new();
    for backend in Backend::ALL {
        match Gpu::open(backend) {
            Ok(gpu) => {
                say!("{backend}: {} ({})", gpu.info().name, gpu.info().driver_info);
                gpus.push((backend, gpu));
            }
            Err(_) => say!("{backend}: no device"),
        }
    }
    gpus
}

/// Milliseconds of frames.
pub(super) struct Times {
    /// Whole frames.
    pub(super) frames: Vec<f64>,
    /// Each pass by itself.
    passes: BTreeMap<&'static str, Vec<f64>>,
    /// In the order of the frame.
    order: Vec<&'static str>,
    pub(super) device_bytes: u64,
    pub(super) material_bytes: u64,
    pub(super) mesh_bytes: u64,
}

impl Times {
    fn line(&self) -> String {
        let passes = self.order.iter().map(|name| format!("{name} {:.1}", median(&self.passes[name])));
        format!(
            "{:8.1} ms, p95 {:.1} ({}); buffers {}",
            median(&self.frames),
            quantile(&self.frames, 0.95),
            passes.collect::<Vec<_>>().join(", "),
            human(self.device_bytes - self.material_bytes - self.mesh_bytes),
        )
    }

    fn json(&self, backend: Backend, mesh: &str, way: &str) -> Value {
        let of = |values: &[f64]| json!({ "median_ms": median(values), "p95_ms": quantile(values, 0.95) });
        let passes: serde_json::Map<String, Value> =
            self.order.iter().map(|name| ((*name).to_owned(), of(&self.passes[name]))).collect();
        json!({
            "backend": backend.to_string(), "mesh": mesh, "path": way, "frame": of(&self.frames), "passes": passes,
            "device_bytes": self.device_bytes, "material_bytes": self.material_bytes, "mesh_bytes": self.mesh_bytes,
        })
    }
}

/// Draws frames under a light that turns; the gather, which takes seconds, once.
pub(super) fn measure(
    gpu: &Gpu,
    ingredients: &Ingredients,
    material: &Bssrdf<'_>,
    mesh: &Mesh,
    size: [u32; 2],
    frames: usize,
) -> anyhow::Result<Times> {
    let mut scene = Shot::usual(size).scene(mesh);
    scene.view.exposure = 0.5;
    let before = gpu.ledger().bytes();
    let prepared = ingredients.upload(gpu, material, mesh)?;
    let is_slow = matches!(prepared, Prepared::Gather { .. });
    let Ready { prepared, renderer, mut frame } = Ready::new(gpu, prepared, &scene, size)?;
    let target = gpu.target(size, RuntimeOptions::default().format)?;
    let device_bytes = gpu.ledger().bytes() - before;

    let frames = if is_slow { 0 } else { frames };
    let bars = Bars::new();
    bars.begin("frames", 2 * frames as u64 + 1);
    let mut times = Times {
        frames: Vec::new(),
        passes: BTreeMap::new(),
        order: Vec::new(),
        device_bytes,
        material_bytes: prepared.material_bytes(),
        mesh_bytes: prepared.mesh_bytes(),
    };
    for number in 0..=frames {
        turn(&mut scene);
        let begin = Instant::now();
        renderer.draw(gpu, &mut frame, &prepared.model(), &scene, target.view())?;
        gpu.finish()?;
        // Drivers compile at the first frame.
        if number > 0 || frames == 0 {
            times.frames.push(ms(begin.elapsed()));
        }
        bars.advance(1);
    }
    for _ in 0..frames {
        turn(&mut scene);
        let passes = renderer.draw_timed(gpu, &mut frame, &prepared.model(), &scene, target.view())?;
        times.order = passes.iter().map(|(name, _)| *name).collect();
        for (name, time) in passes {
            times.passes.entry(name).or_default().push(ms(time));
        }
        bars.advance(1);
    }
    Ok(times)
}

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// Turns the lights by a fifth of a degree.
fn turn(scene: &mut Scene) {
    for light in &mut scene.lights {
        if let LightShape::Directional { towards } = &mut light.shape {
            *towards = Quat::from_axis_angle(Vec3::Y, 0.2_f32.to_radians()) * *towards;
        }
    }
}
