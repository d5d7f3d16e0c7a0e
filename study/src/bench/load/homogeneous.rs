//! Load size and latency of homogeneous materials: kernels, and transfers of one mesh.

use std::path::{Path, PathBuf};

use serde::Serialize;
use serde_json::{Map, json};
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::File;
use subsurf_runtime::{Gpu, GpuMesh, LoadTimer, Stored, Technique, VertexData};
use subsurf_viewer::{DrawnMaterial, human, parse, read, stem};

use super::options::{LoadOptions, load_one};
use super::results::{Step, Steps, Storage};
use crate::bench::meshes::{EXTENT_MM, named};
use crate::bench::timing::{Clock, median, micros};

/// A file, to be loaded again and again.
pub(super) struct HomogeneousLoader<'a> {
    path: &'a Path,
    /// None if nothing is drawn.
    timer: Option<LoadTimer<'a>>,
}

impl<'a> HomogeneousLoader<'a> {
    /// Compiles what an application has before it loads its first kernel, or first transfer where a mesh is named, which is uploaded.
    pub(super) fn new(gpu: Option<&'a Gpu>, path: &'a Path, mesh: Option<&Path>) -> anyhow::Result<Self> {
        let stored = match mesh {
            Some(mesh) => Stored::Transfer(named(mesh, EXTENT_MM)?.1.into()),
            None => Stored::File(Technique::Kernel),
        };
        let timer = gpu.map(|gpu| LoadTimer::new(gpu, stored)).transpose()?;
        Ok(Self { path, timer })
    }

    /// File to picture, once; microseconds of pipelines that were compiled before it or in it; the material's bytes on the device. Without
    /// a device there is no picture.
    pub(super) fn once(&self) -> anyhow::Result<(Steps, f64, u64)> {
        let mut clock = Clock::new();
        let bytes = std::fs::read(self.path)?;
        let read = clock.lap();
        if let Some(timer) = &self.timer {
            return Steps::timed(timer, &bytes, read);
        }
        std::hint::black_box(File::parse(&bytes)?);
        Ok((Steps::by_cpu(read, clock.lap(), 0.0), 0.0, 0))
    }
}

/// Loads kernels, each in a process of its own; or transfers of a mesh.
pub(super) fn run(options: &LoadOptions, files: &[PathBuf], mesh: Option<&Path>) -> anyhow::Result<()> {
    let more = match mesh {
        Some(mesh) => vec!["--mesh".as_ref(), mesh.as_os_str()],
        None => vec!["--kernel".as_ref()],
    };
    let mut loaded: Vec<(String, Storage)> = Vec::new();
    for file in files {
        let bytes = read(file)?;
        match (parse(file, &bytes)?, mesh) {
            (DrawnMaterial::Kernel(_), None) | (DrawnMaterial::Transfer(_), Some(_)) => {}
            (_, mesh) => {
                let wanted = if mesh.is_some() { "transfer" } else { "kernel" };
                return Err(bad_request(format!("{}: no {wanted}; see --case and --files", file.display())));
            }
        }
        loaded.push((stem(file), load_one(file, &more, options)?));
    }
    let of_mesh = mesh.map(|mesh| MeshTimes::of(options, mesh)).transpose()?;
    if options.json {
        let all: Map<_, _> = loaded.iter().map(|(name, storage)| (name.clone(), json!(storage))).collect();
        outln!("{:#}", json!({ "runs": options.runs, "device": options.device()?, "storage": all, "mesh": of_mesh }));
        return Ok(());
    }
    let row = |name: &str, show: &dyn Fn(&Storage) -> String| {
        outln!("| {name} | {} |", loaded.iter().map(|(_, storage)| show(storage)).collect::<Vec<_>>().join(" | "));
    };
    outln!("{}\n", options.device()?);
    if let Some(MeshTimes { bytes, gpu_bytes, read_us, upload_us }) = of_mesh {
        let [read, upload] = [read_us, upload_us].map(micros);
        outln!("mesh: {}, read in {read}; {} on the device, uploaded in {upload}\n", human(bytes), human(gpu_bytes));
    }
    outln!("| | {} |", loaded.iter().map(|(name, _)| &name[..]).collect::<Vec<_>>().join(" | "));
    outln!("|---|{}", "---:|".repeat(loaded.len()));
    row("file", &|storage| human(storage.bytes));
    row("on the device", &|storage| human(storage.gpu_bytes));
    row("pipelines, once", &|storage| micros(storage.pipelines_us));
    let weights: Step = ("weights between the lights", |steps| steps.projection);
    for (name, of) in mesh.map(|_| weights).into_iter().chain(Steps::UNPROJECTED) {
        row(&format!("warm: {name}"), &|storage| micros(of(&storage.warm_us)));
    }
    for (name, of) in Steps::UNPROJECTED {
        let cold = |storage: &Storage| storage.cold_us.as_ref().map_or("-".to_owned(), |steps| micros(of(steps)));
        row(&format!("cold: {name}"), &cold);
    }
    Ok(())
}

/// Size of a mesh, and medians of the times to read it and to bring it to a device; 0 without one.
#[derive(Serialize)]
struct MeshTimes {
    bytes: u64,
    gpu_bytes: u64,
    read_us: f64,
    upload_us: f64,
}

impl MeshTimes {
    fn of(options: &LoadOptions, path: &Path) -> anyhow::Result<Self> {
        let gpu = options.open()?;
        let (mut reads, mut uploads, mut gpu_bytes) = (Vec::new(), Vec::new(), 0);
        for _ in 0..options.runs {
            let mut clock = Clock::new();
            let (_, mesh) = named(path, EXTENT_MM)?;
            reads.push(clock.lap());
            if let Some(gpu) = &gpu {
                let mesh = GpuMesh::upload(gpu, &mesh, VertexData::default())?;
                gpu.finish()?;
                gpu_bytes = mesh.gpu_bytes();
                uploads.push(clock.lap());
            }
        }
        let upload_us = if uploads.is_empty() { 0.0 } else { median(&uploads) };
        // Shapes have no file.
        let bytes = std::fs::metadata(path).map_or(0, |file| file.len());
        Ok(Self { bytes, gpu_bytes, read_us: median(&reads), upload_us })
    }
}
