//! Loads one file again and again, in a process of its own: memory and driver state are not shared with others.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

use subsurf_cli::devices::BackendArg;
use subsurf_cli::outln;
use subsurf_cli::program::memory::resident;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::container::{Container, Crc, crc32};

use super::btf_loader::BtfLoader;
use super::file_loader::FileLoader;
use super::homogeneous::HomogeneousLoader;
use super::options::Way;
use super::results::{Steps, Storage, medians};
use crate::bench::timing::{Clock, median};

/// Load one file and print its times as JSON
#[derive(clap::Args)]
pub(crate) struct Args {
    file: PathBuf,
    /// The images of a BTF
    #[arg(long)]
    images: Option<PathBuf>,
    /// A kernel
    #[arg(long)]
    kernel: bool,
    /// The mesh of a transfer
    #[arg(long)]
    mesh: Option<PathBuf>,
    /// What a translucent material is drawn by
    #[arg(long, value_enum, default_value = "gather")]
    way: Way,
    #[arg(long)]
    runs: usize,
    #[arg(long, value_enum)]
    backend: BackendArg,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let gpu = args.backend.open()?;
    // What there is before anything of the file is: the driver.
    let baseline = resident().map_or(0, |memory| memory.peak);
    if let Some(images) = &args.images {
        let loader = BtfLoader::new(gpu.as_ref(), &args.file, images)?;
        return report(args, baseline, || loader.once(), || Ok(BTreeMap::new()));
    }
    if args.kernel || args.mesh.is_some() {
        let loader = HomogeneousLoader::new(gpu.as_ref(), &args.file, args.mesh.as_deref())?;
        return report(args, baseline, || loader.once(), || Ok(BTreeMap::new()));
    }
    let is_capture = args.file.extension().is_some_and(|extension| extension == "npy");
    let loader = FileLoader::new(gpu.as_ref(), &args.file, args.way)?;
    let parts =
        || Ok(if is_capture { BTreeMap::new() } else { parts_of_parse(&std::fs::read(&args.file)?, args.runs) });
    report(args, baseline, || loader.once(), parts)
}

/// Runs, warm and cold, and says what they took.
fn report(
    args: &Args,
    baseline: u64,
    once: impl Fn() -> anyhow::Result<(Steps, f64, u64)>,
    parts_us: impl FnOnce() -> anyhow::Result<BTreeMap<String, f64>>,
) -> anyhow::Result<()> {
    // One run whose steps do not count: pipelines, driver caches, page cache.
    let (_, pipelines_us, gpu_bytes) = once()?;
    let steps = || once().map(|(steps, ..)| steps);
    let warm: Vec<Steps> = (0..args.runs).map(|_| steps()).collect::<anyhow::Result<_>>()?;
    let mut cold = Vec::new();
    for _ in 0..args.runs {
        if !drop_from_cache(&args.file)? {
            break;
        }
        cold.push(steps()?);
    }
    let peak_rss_bytes = resident().map_or(0, |memory| memory.peak);
    let result = Storage {
        bytes: std::fs::metadata(&args.file)?.len(),
        gpu_bytes,
        peak_rss_bytes,
        baseline_rss_bytes: baseline,
        pipelines_us,
        warm_us: medians(&warm),
        cold_us: (!cold.is_empty()).then(|| medians(&cold)),
        parts_us: parts_us()?,
    };
    outln!("{}", serde_json::to_string(&result)?);
    Ok(())
}

/// What parsing consists of, and a copy of the file for scale.
fn parts_of_parse(bytes: &[u8], runs: usize) -> BTreeMap<String, f64> {
    let mut copy = vec![0_u8; bytes.len()];
    let mut time = |work: &mut dyn FnMut(&mut [u8]) -> usize| {
        let laps = (0..runs.max(20)).map(|_| {
            let mut clock = Clock::new();
            std::hint::black_box(work(std::hint::black_box(&mut copy)));
            clock.lap()
        });
        median(&laps.collect::<Vec<_>>())
    };
    let memcpy = time(&mut |copy| {
        copy.copy_from_slice(std::hint::black_box(bytes));
        copy.len()
    });
    let checks = time(&mut |_| {
        let material = Bssrdf::parse_with(std::hint::black_box(bytes), Crc::Skip);
        material.map_or(0, |material| material.header().width as usize)
    });
    let crc = time(&mut |_| {
        let container = Container::parse(std::hint::black_box(bytes));
        let sums = container.iter().flat_map(|container| {
            container.entries().filter_map(|entry| container.section(entry.section, Crc::Skip).ok())
        });
        sums.map(|(_, section)| crc32(section) as usize).fold(0, usize::wrapping_add)
    });
    [("memcpy_us", memcpy), ("checks_us", checks), ("crc_us", crc)].map(|(name, us)| (name.to_owned(), us)).into()
}

/// Drops a file's pages from the page cache; false where the system has no way to.
#[cfg(target_os = "linux")]
fn drop_from_cache(path: &Path) -> anyhow::Result<bool> {
    let file = File::open(path)?;
    // Pages that are not on disk yet cannot be dropped.
    file.sync_all()?;
    rustix::fs::fadvise(&file, 0, None, rustix::fs::Advice::DontNeed)?;
    Ok(true)
}

#[cfg(not(target_os = "linux"))]
fn drop_from_cache(path: &Path) -> anyhow::Result<bool> {
    File::open(path)?;
    Ok(false)
}
