//! Loads one file again and again, in a process of its own: memory and driver state are not shared with others.

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};
use std::time::Instant;

use anyhow::Context;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::layout::MODEL_2BMPP;
use subsurf_decoder::bssrdf::{Coding, Header};
use subsurf_decoder::container::{Container, Crc, crc32};
use subsurf_encoder::capture::{Capture, Overrides};
use subsurf_runtime::{Gpu, Material, MaterialLayout, PatchLight, PatchRenderer, Region, layout_of};
use subsurf_shaders::Rgb;
use subsurf_shaders::cpu::{self, Reflectance};

use super::load_btf;
use super::timing::{Steps, Storage, median, medians};
use crate::devices::BackendArg;
use crate::memory::resident;
use crate::say::say;

/// Load one file and print its times as JSON
#[derive(clap::Args)]
pub(crate) struct Args {
    file: PathBuf,
    /// The images of a BTF
    #[arg(long)]
    images: Option<PathBuf>,
    #[arg(long)]
    runs: usize,
    #[arg(long, value_enum)]
    backend: BackendArg,
}

/// Pixels to a side of the first frame.
const FRAME: u32 = 64;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    let gpu = args.backend.open()?;
    // What there is before anything of the file is: the driver.
    let baseline = resident().map_or(0, |memory| memory.peak);
    if let Some(images) = &args.images {
        let bench = load_btf::Bench::new(gpu.as_ref(), &args.file, images)?;
        return report(args, baseline, || bench.once(), || Ok(BTreeMap::new()));
    }
    let is_capture = args.file.extension().is_some_and(|extension| extension == "npy");
    let (header, layout) = describe(&args.file, is_capture)?;
    let bench = Bench::new(gpu.as_ref(), &args.file, header, layout)?;
    let parts =
        || Ok(if is_capture { BTreeMap::new() } else { parts_of_parse(&std::fs::read(&args.file)?, args.runs) });
    report(args, baseline, || bench.once(), parts)
}

/// Runs, warm and cold, and says what they took.
fn report(
    args: &Args,
    baseline: u64,
    bench: impl Fn() -> anyhow::Result<(Steps, u64)>,
    parts_us: impl FnOnce() -> anyhow::Result<BTreeMap<String, f64>>,
) -> anyhow::Result<()> {
    // One run that does not count: driver caches, page cache.
    let (_, gpu_bytes) = bench()?;
    let once = || bench().map(|(steps, _)| steps);
    let warm: Vec<Steps> = (0..args.runs).map(|_| once()).collect::<anyhow::Result<_>>()?;
    let mut cold = Vec::new();
    for _ in 0..args.runs {
        if !drop_from_cache(&args.file)? {
            break;
        }
        cold.push(once()?);
    }
    let peak_rss_bytes = resident().map_or(0, |memory| memory.peak);
    let result = Storage {
        bytes: std::fs::metadata(&args.file)?.len(),
        gpu_bytes,
        peak_rss_bytes,
        baseline_rss_bytes: baseline,
        warm_us: medians(&warm),
        cold_us: (!cold.is_empty()).then(|| medians(&cold)),
        parts_us: parts_us()?,
    };
    say!("{}", serde_json::to_string(&result)?);
    Ok(())
}

/// What the header says, and how the device will hold it.
fn describe(path: &Path, is_capture: bool) -> anyhow::Result<(Header, MaterialLayout)> {
    if is_capture {
        let capture = Capture::open(path, &Overrides::default())?;
        return Ok((header_of(&capture)?, MaterialLayout::Capture));
    }
    let bytes = std::fs::read(path)?;
    let material = crate::info::parse(path, &bytes)?;
    Ok((*material.header(), layout_of(&material)))
}

/// A capture has no profiles; everything else is as in a file.
fn header_of(capture: &Capture) -> anyhow::Result<Header> {
    let radius = u16::try_from(capture.radius())?;
    Ok(Header {
        model: MODEL_2BMPP,
        coding: Coding::Exact,
        addressing: capture.addressing(),
        width: u32::try_from(capture.width())?,
        height: u32::try_from(capture.height())?,
        window_radius: radius,
        samples: 2,
        base_materials: 1,
        pitch_mm: capture.pitch_mm(),
        r_max_mm: f32::from(radius.max(1)) * 1.5 * capture.pitch_mm(),
        eta: capture.eta(),
    })
}

struct Bench<'a> {
    gpu: Option<&'a Gpu>,
    path: &'a Path,
    header: Header,
    layout: MaterialLayout,
    /// What an application has before it loads its first material: pipelines, and light.
    renderer: Option<PatchRenderer>,
    irradiance: Vec<Rgb>,
    region: Region,
}

impl<'a> Bench<'a> {
    fn new(gpu: Option<&'a Gpu>, path: &'a Path, header: Header, layout: MaterialLayout) -> anyhow::Result<Self> {
        let renderer = gpu.map(|gpu| PatchRenderer::new(gpu, layout)).transpose()?;
        let size = [header.width.min(FRAME), header.height.min(FRAME)];
        let origin = [(header.width - size[0]) / 2, (header.height - size[1]) / 2];
        Ok(Self {
            gpu,
            path,
            header,
            layout,
            renderer,
            irradiance: vec![[1.0; 3]; (header.width * header.height) as usize],
            region: Region { origin, size },
        })
    }

    /// File to picture, once; and the material's bytes on the device.
    fn once(&self) -> anyhow::Result<(Steps, u64)> {
        let mut clock = Clock::new();
        let bytes = std::fs::read(self.path)?;
        let read = clock.lap();

        // A capture's array starts where its header ends; there is nothing else to check.
        let entries = match self.layout {
            MaterialLayout::Capture => Some(self.entries_of(&bytes)?),
            _ => None,
        };
        let material = if entries.is_none() { Some(crate::info::parse(self.path, &bytes)?) } else { None };
        let parse = clock.lap();

        let (upload, first_frame, gpu_bytes) = match (self.gpu, &self.renderer) {
            (Some(gpu), Some(renderer)) => {
                let uploaded = self.upload(gpu, material.as_ref(), entries.unwrap_or(&[]))?;
                let light = PatchLight::upload(gpu, [self.header.width, self.header.height], &self.irradiance)?;
                gpu.finish()?;
                let upload = clock.lap();
                let exitance = renderer.gather(gpu, &uploaded, &light, self.region)?;
                renderer.picture(gpu, &exitance, self.region.size, 1.0)?;
                (upload, clock.lap(), uploaded.gpu_bytes())
            }
            _ => {
                let (origin, size) = (self.region.origin, self.region.size);
                let exitance = match &material {
                    Some(material) => cpu::gather(material, &self.irradiance, origin, size),
                    None => {
                        let entries = Entries { header: self.header, entries: entries.unwrap_or(&[]) };
                        cpu::gather(&entries, &self.irradiance, origin, size)
                    }
                };
                std::hint::black_box(cpu::present(&exitance, size, size, 1.0));
                (0.0, clock.lap(), 0)
            }
        };
        Ok((Steps { read, parse, upload, first_frame, total: read + parse + upload + first_frame }, gpu_bytes))
    }

    fn upload(&self, gpu: &Gpu, material: Option<&Bssrdf<'_>>, entries: &[u8]) -> anyhow::Result<Material> {
        Ok(match material {
            Some(material) => Material::upload(gpu, material)?,
            None => Material::upload_capture(gpu, &self.header, entries)?,
        })
    }

    fn entries_of<'b>(&self, bytes: &'b [u8]) -> anyhow::Result<&'b [u8]> {
        let capture = Capture::open(self.path, &Overrides::default())?;
        let len = capture.pixels() * capture.window_len() * size_of::<f32>();
        let start = bytes.len().checked_sub(len).context("captures for timing are float32")?;
        Ok(&bytes[start..])
    }
}

/// The CPU twin's view of a capture.
struct Entries<'a> {
    header: Header,
    entries: &'a [u8],
}

impl Reflectance for Entries<'_> {
    fn header(&self) -> &Header {
        &self.header
    }

    fn rd(&self, x_i: [i32; 2], x_o: [i32; 2]) -> Rgb {
        let radius = i32::from(self.header.window_radius);
        let d = 2 * radius + 1;
        let x = self.header.addressing.map(x_i[0], self.header.width) as usize;
        let y = self.header.addressing.map(x_i[1], self.header.height) as usize;
        let place = usize::try_from((x_o[1] - x_i[1] + radius) * d + (x_o[0] - x_i[0] + radius)).unwrap_or(0);
        let window = usize::try_from(d * d).unwrap_or(0);
        let first = ((y * self.header.width as usize + x) * window + place) * 3;
        [0, 1, 2].map(|c| {
            let bytes = self.entries.get((first + c) * 4..).and_then(|rest| rest.first_chunk::<4>());
            let rd = bytes.map_or(0.0, |bytes| f32::from_le_bytes(*bytes));
            if rd > 0.0 { rd } else { 0.0 }
        })
    }
}

/// Microseconds from lap to lap.
pub(super) struct Clock(Instant);

impl Clock {
    pub(super) fn new() -> Self {
        Self(Instant::now())
    }

    pub(super) fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let lap = now.duration_since(self.0).as_secs_f64() * 1e6;
        self.0 = now;
        lap
    }
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
