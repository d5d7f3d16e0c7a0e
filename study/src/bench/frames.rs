//! `subsurf bench frames`: how long frames take, pass by pass.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::synthetic::per_pixel_of;
use subsurf_runtime::Backend;
use subsurf_runtime::scene::{Mesh, relief};

use super::course::{self, Course, Times};
use super::timing::{median, quantile};
use crate::devices::to_compare;
use crate::failure::bad_request;
use crate::info::{parse, read_file};
use crate::memory::human;
use crate::mesh::{Up, fitted, load, stem};
use crate::options::Size;
use crate::render::{Ingredients, MappingArg, PathArg, Shot, choose_mapping};
use crate::say::say;

/// Time frames of meshes of 5 to 871 thousand triangles, pass by pass, on every device there is.
///
/// The light turns a little from frame to frame, so that everything is computed anew; paths take turns. Times are
/// wall-clock milliseconds until the device is through; compare those of one run.
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
    let gpus = to_compare();
    let mut all = Vec::new();
    for (name, mesh) in &meshes {
        say!("{name}, {} triangles, {}x{} pixels", mesh.triangles.len(), args.size.0[0], args.size.0[1]);
        let mapping = choose_mapping(mesh, MappingArg::Auto, &material)?;
        let scene = Shot::usual(args.size.0).scene(mesh);
        let mut sky = None;
        let mut known = Vec::new();
        for (way, material, path) in ways {
            let ingredients = Ingredients::compute(material, mesh, mapping, &scene, path, sky.clone())?;
            sky = sky.or(ingredients.sky().cloned());
            known.push((way, material, ingredients));
        }
        for (backend, gpu) in &gpus {
            let course = |(_, material, ingredients): &(&str, &Bssrdf<'_>, Ingredients)| {
                Course::new(gpu, ingredients, material, mesh, args.size.0)
            };
            let mut courses = known.iter().map(course).collect::<anyhow::Result<Vec<_>>>()?;
            course::run(gpu, &mut courses, mesh, args.size.0, args.frames)?;
            for (course, (way, ..)) in courses.iter().zip(&known) {
                say!("  {backend:10} {way:26} {}", line(&course.times));
                all.push(report(&course.times, *backend, name, way));
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

fn line(times: &Times) -> String {
    let passes = times.order.iter().map(|name| format!("{name} {:.1}", median(&times.passes[name])));
    format!(
        "{:8.1} ms, p95 {:.1} ({}); buffers {}",
        median(&times.frames),
        quantile(&times.frames, 0.95),
        passes.collect::<Vec<_>>().join(", "),
        human(times.buffer_bytes),
    )
}

fn report(times: &Times, backend: Backend, mesh: &str, way: &str) -> Value {
    let of = |values: &[f64]| json!({ "median_ms": median(values), "p95_ms": quantile(values, 0.95) });
    let passes: serde_json::Map<String, Value> =
        times.order.iter().map(|name| ((*name).to_owned(), of(&times.passes[name]))).collect();
    json!({
        "backend": backend.to_string(), "mesh": mesh, "path": way, "frame": of(&times.frames), "passes": passes,
        "material_bytes": times.material_bytes, "buffer_bytes": times.buffer_bytes,
    })
}
