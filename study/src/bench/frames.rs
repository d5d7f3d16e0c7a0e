//! `subsurf-study bench frames`: how long frames take, pass by pass.

use std::path::PathBuf;
use std::sync::Arc;

use serde_json::{Value, json};
use subsurf_cli::options::Size;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::{Bssrdf, Kernel, Transfer};
use subsurf_encoder::baseline::song2009::per_pixel_of;
use subsurf_runtime::{Backend, Gpu, Load};
use subsurf_scene::{AmbientTransfer, Mesh, relief};
use subsurf_viewer::{
    Asset, DrawnMaterial, GpuAsset, MappingChoice, RenderRequest, Scattering, choose_mapping, human, parse, read,
};

use super::case::{self, BenchCase, Times};
use super::devices::to_compare;
use super::meshes::{EXTENT_MM, named};
use super::timing::{median, quantile};

/// Time frames of meshes of 5 to 871 thousand triangles, pass by pass, on every device there is, of a translucent material, a kernel or a transfer.
///
/// The light turns a little from frame to frame, so that everything is computed anew; paths take turns. Times of frames are
/// wall-clock milliseconds until the device is through; those of passes are timestamps of the device within whole frames where
/// it has them (Vulkan), else each pass is waited for. Compare those of one run. Bytes are those of the ledger, by purpose.
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

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.frames == 0 {
        return Err(bad_request("--frames is 0; at least one is needed for a time"));
    }
    let bytes = read(&args.file)?;
    let material = parse(&args.file, &bytes)?;
    let meshes: Vec<(String, Mesh)> = match &args.meshes[..] {
        [] => RELIEFS.iter().map(|&rings| bumpy_sphere(rings)).collect::<anyhow::Result<_>>()?,
        paths => paths.iter().map(|path| named(path, EXTENT_MM)).collect::<anyhow::Result<_>>()?,
    };
    let mut all = Vec::new();
    for (name, mesh) in &meshes {
        outln!("{name}, {} triangles, {}x{} pixels", mesh.triangles.len(), args.size.0[0], args.size.0[1]);
        all.extend(match &material {
            DrawnMaterial::Bssrdf(material) => bssrdf_frames(args, material, name, mesh)?,
            DrawnMaterial::Kernel(kernel) => kernel_frames(args, kernel, name, mesh)?,
            DrawnMaterial::Transfer(transfer) => transfer_frames(args, transfer, name, mesh)?,
            DrawnMaterial::Btf(_) => return Err(bad_request("a BTF, whose frames `bench btf` times")),
        });
    }
    if args.json {
        outln!("{:#}", Value::Array(all));
    }
    Ok(())
}

/// Frames of a translucent material by all techniques, which take turns.
fn bssrdf_frames(args: &Args, material: &Bssrdf<'_>, name: &str, mesh: &Mesh) -> anyhow::Result<Vec<Value>> {
    let profiles = per_pixel_of(material);
    let profiles = Bssrdf::parse(&profiles)?;
    let modes = [
        ("splat", material, Scattering::Splat),
        ("splat, per-pixel profiles", &profiles, Scattering::Splat),
        ("separable", material, Scattering::Separable),
        ("homogeneous", material, Scattering::Homogeneous),
    ];
    let mapping = choose_mapping(mesh, MappingChoice::Auto, material)?;
    let scene = RenderRequest::usual(args.size.0).scene(mesh);
    let mut sky = None;
    let mut assets = Vec::new();
    for (_, material, technique) in modes {
        let asset = Asset::compute(material, mesh, mapping, &scene, technique, sky.clone())?;
        sky = sky.or(asset.sky().cloned());
        assets.push((material, asset));
    }
    let mut all = Vec::new();
    for (backend, gpu) in &to_compare() {
        let case = |(material, asset): &(&Bssrdf<'_>, Asset)| {
            BenchCase::new(gpu, || asset.upload(gpu, material, mesh), mesh, args.size.0)
        };
        let mut cases = assets.iter().map(case).collect::<anyhow::Result<Vec<_>>>()?;
        all.extend(timed(args, (*backend, gpu), &mut cases, &modes.map(|(mode, ..)| mode), (name, mesh))?);
    }
    Ok(all)
}

/// Frames of a homogeneous material by its separable kernel.
fn kernel_frames(args: &Args, kernel: &Kernel<'_>, name: &str, mesh: &Mesh) -> anyhow::Result<Vec<Value>> {
    let sky = AmbientTransfer::of_kernel(mesh, kernel)?;
    let mut all = Vec::new();
    for (backend, gpu) in &to_compare() {
        let mut cases = [BenchCase::new(gpu, || GpuAsset::kernel(gpu, mesh, kernel, &sky), mesh, args.size.0)?];
        all.extend(timed(args, (*backend, gpu), &mut cases, &["kernel"], (name, mesh))?);
    }
    Ok(all)
}

/// Frames of a mesh whose scattering is precomputed.
fn transfer_frames(args: &Args, transfer: &Transfer<'_>, name: &str, mesh: &Mesh) -> anyhow::Result<Vec<Value>> {
    let mut all = Vec::new();
    for (backend, gpu) in &to_compare() {
        let bare = || {
            let asset = GpuAsset::transfer(gpu, mesh, transfer)?;
            let material = Load::transfer(gpu, transfer)?.finish()?;
            let material = Arc::into_inner(material).map(|material| Arc::new(material.bare()).into());
            Ok(GpuAsset { material: material.expect("the load is through"), ..asset })
        };
        let mut cases = [
            BenchCase::new(gpu, || GpuAsset::transfer(gpu, mesh, transfer), mesh, args.size.0)?,
            BenchCase::new(gpu, bare, mesh, args.size.0)?,
        ];
        all.extend(timed(args, (*backend, gpu), &mut cases, &["transfer", "without scattering"], (name, mesh))?);
    }
    Ok(all)
}

/// Times cases on a device, prints a line and the memory of each, and reports them.
fn timed(
    args: &Args,
    (backend, gpu): (Backend, &Gpu),
    cases: &mut [BenchCase],
    modes: &[&str],
    (name, mesh): (&str, &Mesh),
) -> anyhow::Result<Vec<Value>> {
    case::run(gpu, cases, mesh, args.size.0, args.frames)?;
    let each = cases.iter().zip(modes).map(|(case, mode)| {
        outln!("  {backend:10} {mode:26} {}", line(&case.times));
        outln!("  {:10} {:26} {}", "", "", memory(&case.times));
        report(&case.times, backend, name, mode)
    });
    Ok(each.collect())
}

fn bumpy_sphere(rings: u16) -> anyhow::Result<(String, Mesh)> {
    Ok(("bumpy sphere".to_owned(), relief(20.0, 8, rings).fitted(EXTENT_MM)?))
}

fn line(times: &Times) -> String {
    let passes = times.order.iter().map(|name| format!("{name} {:.1}", median(&times.passes[name])));
    format!(
        "{:8.1} ms, p95 {:.1}; passes {}: {}",
        median(&times.frames),
        quantile(&times.frames, 0.95),
        timed_by(times),
        passes.collect::<Vec<_>>().join(", "),
    )
}

/// Bytes on the device by their purpose, and how many there are besides material and mesh.
fn memory(times: &Times) -> String {
    let by_purpose = times.bytes.iter().map(|(purpose, bytes)| format!("{purpose} {}", human(*bytes)));
    let [_, buffers] = times.bytes_of_material_and_buffers();
    format!("{}; without material and mesh {}", by_purpose.collect::<Vec<_>>().join(", "), human(buffers))
}

fn timed_by(times: &Times) -> &'static str {
    if times.is_by_device { "by timestamps" } else { "one by one" }
}

fn report(times: &Times, backend: Backend, mesh: &str, mode: &str) -> Value {
    let of = |values: &[f64]| json!({ "median_ms": median(values), "p95_ms": quantile(values, 0.95) });
    let passes: serde_json::Map<String, Value> =
        times.order.iter().map(|name| ((*name).to_owned(), of(&times.passes[name]))).collect();
    let bytes: serde_json::Map<String, Value> =
        times.bytes.iter().map(|(purpose, bytes)| (purpose.to_string(), json!(bytes))).collect();
    json!({
        "backend": backend.to_string(), "mesh": mesh, "path": mode, "frame": of(&times.frames), "passes": passes,
        "passes_timed": timed_by(times), "bytes": bytes,
    })
}
