//! How long files take to load on this device, for `adb shell` and for every other machine: the measurements of
//! `subsurf-study bench load`, as CSV, times in microseconds.
//!
//! `load_test [--vulkan | --gl] [--repeats N] [--raw FOLDER] FILE..` runs each technique of each file once from a cold start (pipelines
//! are compiled, and the file is dropped from the page cache where the system lets us), then N times warm (20). `gather` is a flat
//! patch, the others are on a mesh. `open_us` is the device's opening, `drawable_us` all but pipelines until the material can be drawn.
//! With `--raw` the capture or the images that a file stands for are loaded too, uncompressed, from arrays that are written into a
//! folder and deleted: 12 bytes for every pair of pixels, 3 for every texel and pair of 81 directions. Without a device it reads and
//! checks.

mod raw;

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::{Duration, Instant};

use subsurf_decoder::{Content, File};
use subsurf_runtime::{Backend, BtfLayout, Gpu, LoadTimer, LoadTimes, Stored, Technique, layout_of};

use crate::raw::RawFile;

type Failed = Box<dyn std::error::Error>;

/// One load.
struct Run {
    read: Duration,
    times: LoadTimes,
    /// Pipelines of frames and of the load.
    pipelines: Duration,
}

/// What is timed of a file, by name: first what an app gets that does not choose.
fn techniques(file: &File<'_>) -> Vec<(&'static str, Stored)> {
    match file.content() {
        Content::Bssrdf(material) => {
            let layout = layout_of(&material);
            let planes = [("splat", Stored::File(Technique::Splat(layout))), ("gather", Stored::Planes(layout))];
            let separable = material.basis().map(|basis| Technique::Separable(basis.size().terms));
            separable.map(|technique| ("separable", Stored::File(technique))).into_iter().chain(planes).collect()
        }
        Content::NestedBtf(_) => vec![("btf", Stored::File(Technique::Btf(BtfLayout::Nested)))],
        Content::Kernel(_) => vec![("kernel", Stored::File(Technique::Kernel))],
        _ => Vec::new(),
    }
}

/// Reads a file, once, and loads it if there is something to load it onto.
fn once(path: &Path, timer: Option<&LoadTimer<'_>>) -> Result<Run, Failed> {
    let begin = Instant::now();
    let bytes = std::fs::read(path)?;
    let read = begin.elapsed();
    let Some(timer) = timer else {
        let begin = Instant::now();
        File::parse(&bytes)?;
        let times = LoadTimes { parse: begin.elapsed(), ..LoadTimes::default() };
        return Ok(Run { read, times, pipelines: Duration::ZERO });
    };
    let times = timer.load(&bytes)?;
    Ok(Run { read, times, pipelines: times.pipelines })
}

/// Drops a file from the page cache, once its pages are on disk.
#[cfg(target_os = "linux")]
fn drop_from_cache(path: &Path) -> Result<(), Failed> {
    let file = std::fs::File::open(path)?;
    file.sync_all()?;
    Ok(rustix::fs::fadvise(file, 0, None, rustix::fs::Advice::DontNeed)?)
}

/// Leaves a file in the page cache: this system has no way to drop it.
#[cfg(not(target_os = "linux"))]
fn drop_from_cache(_: &Path) -> Result<(), Failed> {
    Ok(())
}

/// Value below which a share of some values lies, by nearest rank.
fn quantile(values: &mut [u128], share: f64) -> u128 {
    values.sort_unstable();
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few")]
    let rank = (share * values.len() as f64).ceil() as usize;
    values[rank.clamp(1, values.len()) - 1]
}

/// Times of a run in the order of the table.
fn columns(run: &Run) -> [u128; 8] {
    let LoadTimes { parse, upload, recording, projection, first_frame, .. } = run.times;
    let drawable = run.read + run.times.drawable();
    [run.read, parse, upload, run.pipelines, recording, projection, first_frame, drawable].map(|time| time.as_micros())
}

/// Prints the lines of a technique: from a cold start, and warm.
fn measure(
    path: &Path,
    technique: &str,
    device: &str,
    timer: Option<&LoadTimer<'_>>,
    repeats: usize,
) -> Result<(), Failed> {
    drop_from_cache(path)?;
    let mut first = once(path, timer)?;
    first.pipelines += timer.map_or(Duration::ZERO, LoadTimer::compiled);
    let warm: Vec<Run> = (0..repeats).map(|_| once(path, timer)).collect::<Result<_, _>>()?;
    let of_warm = |share: f64| {
        std::array::from_fn(|k| quantile(&mut warm.iter().map(|run| columns(run)[k]).collect::<Vec<_>>(), share))
    };
    let bytes = std::fs::metadata(path)?.len();
    for (row, columns) in [("cold", columns(&first)), ("median", of_warm(0.5)), ("p95", of_warm(0.95))] {
        let columns = columns.map(|column| column.to_string()).join(",");
        println!("\"{}\",{bytes},{technique},{device},{row},{columns},{}", path.display(), first.times.gpu_bytes);
    }
    Ok(())
}

/// Measures all techniques of a file, and what it stands for if there is a folder for that.
fn measure_all(
    path: &Path,
    gpu: Option<&Gpu>,
    open: Duration,
    repeats: usize,
    folder: Option<&Path>,
) -> Result<(), Failed> {
    let Some(gpu) = gpu else { return measure(path, "decoder", "\"none\",\"\",0", None, repeats) };
    let (bytes, info) = (std::fs::read(path)?, gpu.info());
    let file = File::parse(&bytes)?;
    let device = format!("\"{}\",\"{} {}\",{}", info.name, info.driver, info.driver_info, open.as_micros());
    for (technique, stored) in techniques(&file) {
        measure(path, technique, &device, Some(&LoadTimer::new(gpu, stored)?), repeats)?;
    }
    let Some(raw) = folder.and_then(|folder| RawFile::write(path, &file, folder).transpose()) else { return Ok(()) };
    let raw = raw?;
    let (name, stored) = raw.stored.clone();
    measure(&raw.path, name, &device, Some(&LoadTimer::new(gpu, stored)?), repeats)
}

fn main() -> ExitCode {
    let Err(error) = run() else { return ExitCode::SUCCESS };
    // Drivers speak in many lines.
    let text = error.to_string().split_whitespace().collect::<Vec<_>>().join(" ");
    eprintln!("load_test: {text}");
    ExitCode::FAILURE
}

/// Measures what the arguments say.
fn run() -> Result<(), Failed> {
    let mut backends = Backend::ALL.to_vec();
    let (mut repeats, mut files, mut folder) = (20, Vec::<PathBuf>::new(), None::<PathBuf>);
    let mut arguments = std::env::args().skip(1);
    while let Some(argument) = arguments.next() {
        match argument.as_str() {
            "--vulkan" => backends = vec![Backend::Vulkan],
            "--gl" => backends = vec![Backend::Gl],
            "--repeats" => repeats = arguments.next().ok_or("--repeats N")?.parse()?,
            "--raw" => folder = Some(arguments.next().ok_or("--raw FOLDER")?.into()),
            _ => files.push(argument.into()),
        }
    }
    if files.is_empty() || repeats == 0 {
        return Err("load_test [--vulkan | --gl] [--repeats N] [--raw FOLDER] FILE.., with N more than 0".into());
    }
    let begin = Instant::now();
    let gpu = backends.into_iter().find_map(|backend| Gpu::open(backend).ok());
    let open = begin.elapsed();
    println!(
        "file,bytes,technique,device,driver,open_us,run,read_us,parse_us,upload_us,pipelines_us,recording_us,projection_us,first_frame_us,\
         drawable_us,gpu_bytes"
    );
    for file in files {
        measure_all(&file, gpu.as_ref(), open, repeats, folder.as_deref())
            .map_err(|error| format!("{}: {error}", file.display()))?;
    }
    Ok(())
}
