//! Load size and latency of kernels of homogeneous materials.

use std::path::{Path, PathBuf};

use serde_json::{Map, json};
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::Kernel;
use subsurf_runtime::{Gpu, LoadTimer, Stored, Technique};
use subsurf_viewer::{DrawnMaterial, human, parse, read, stem};

use super::options::{LoadOptions, load_one};
use super::results::{Steps, Storage};
use crate::bench::timing::{Clock, micros};

/// A kernel, to be loaded again and again.
pub(super) struct KernelLoader<'a> {
    path: &'a Path,
    /// None if nothing is drawn.
    timer: Option<LoadTimer<'a>>,
}

impl<'a> KernelLoader<'a> {
    /// Compiles what an application has before it loads its first kernel.
    pub(super) fn new(gpu: Option<&'a Gpu>, path: &'a Path) -> anyhow::Result<Self> {
        let timer = gpu.map(|gpu| LoadTimer::new(gpu, Stored::File(Technique::Kernel))).transpose()?;
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
        std::hint::black_box(Kernel::parse(&bytes)?);
        Ok((Steps::by_cpu(read, clock.lap(), 0.0), 0.0, 0))
    }
}

/// Loads kernels, each in a process of its own.
pub(super) fn run(options: &LoadOptions, files: &[PathBuf]) -> anyhow::Result<()> {
    let mut loaded: Vec<(String, Storage)> = Vec::new();
    for file in files {
        let bytes = read(file)?;
        let DrawnMaterial::Kernel(_) = parse(file, &bytes)? else {
            let name = file.display();
            return Err(bad_request(format!("{name}: no kernel; see --case and --files")));
        };
        loaded.push((stem(file), load_one(file, &["--kernel".as_ref()], options)?));
    }
    if options.json {
        let all: Map<_, _> = loaded.iter().map(|(name, storage)| (name.clone(), json!(storage))).collect();
        outln!("{:#}", json!({ "runs": options.runs, "device": options.device()?, "storage": all }));
        return Ok(());
    }
    let row = |name: &str, show: &dyn Fn(&Storage) -> String| {
        outln!("| {name} | {} |", loaded.iter().map(|(_, storage)| show(storage)).collect::<Vec<_>>().join(" | "));
    };
    outln!("{}\n", options.device()?);
    outln!("| | {} |", loaded.iter().map(|(name, _)| &name[..]).collect::<Vec<_>>().join(" | "));
    outln!("|---|{}", "---:|".repeat(loaded.len()));
    row("file", &|storage| human(storage.bytes));
    row("on the device", &|storage| human(storage.gpu_bytes));
    row("pipelines, once", &|storage| micros(storage.pipelines_us));
    for (name, of) in Steps::UNPROJECTED {
        row(&format!("warm: {name}"), &|storage| micros(of(&storage.warm_us)));
    }
    for (name, of) in Steps::UNPROJECTED {
        let cold = |storage: &Storage| storage.cold_us.as_ref().map_or("-".to_owned(), |steps| micros(of(steps)));
        row(&format!("cold: {name}"), &cold);
    }
    Ok(())
}
