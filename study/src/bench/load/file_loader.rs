//! Loads a capture, or a file of a translucent material: read, parsed, uploaded, drawn once.

use std::path::Path;

use anyhow::Context;
use subsurf_cli::info::parse;
use subsurf_decoder::bssrdf::layout::MODEL_2BMPP;
use subsurf_decoder::bssrdf::{BssrdfHeader, Coding};
use subsurf_encoder::capture::{Capture, Overrides};
use subsurf_runtime::{Gpu, LoadTimer, MaterialLayout, Stored, Technique, layout_of};
use subsurf_shaders::Rgb;
use subsurf_shaders::cpu::{self, Reflectance};

use super::options::Way;
use super::results::Steps;
use crate::bench::timing::Clock;

/// Pixels to a side of the first frame.
const FRAME: u32 = 64;

/// What the header says, how the device will hold it, and what is timed.
fn describe(path: &Path, way: Way) -> anyhow::Result<(BssrdfHeader, MaterialLayout, Stored)> {
    if path.extension().is_some_and(|extension| extension == "npy") {
        let header = header_of(&Capture::open(path, &Overrides::default())?)?;
        return Ok((header, MaterialLayout::Capture, Stored::Capture(header)));
    }
    let bytes = std::fs::read(path)?;
    let material = parse(path, &bytes)?;
    let layout = layout_of(&material);
    let stored = match way {
        Way::Gather => Stored::Planes(layout),
        Way::Splat => Stored::File(Technique::Splat(layout)),
        Way::Separable => {
            let basis = material.basis().context("the file has no separable basis")?;
            Stored::File(Technique::Separable(basis.size().terms))
        }
    };
    Ok((*material.header(), layout, stored))
}

/// A capture has no profiles; everything else is as in a file.
fn header_of(capture: &Capture) -> anyhow::Result<BssrdfHeader> {
    let radius = u16::try_from(capture.radius())?;
    Ok(BssrdfHeader {
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

/// A capture, or a file of a translucent material, to be loaded again and again.
pub(super) struct FileLoader<'a> {
    path: &'a Path,
    header: BssrdfHeader,
    layout: MaterialLayout,
    /// None if the picture is drawn on the CPU.
    timer: Option<LoadTimer<'a>>,
}

impl<'a> FileLoader<'a> {
    /// Compiles what an application has before it loads its first material.
    pub(super) fn new(gpu: Option<&'a Gpu>, path: &'a Path, way: Way) -> anyhow::Result<Self> {
        let (header, layout, stored) = describe(path, way)?;
        Ok(Self { path, header, layout, timer: gpu.map(|gpu| LoadTimer::new(gpu, stored)).transpose()? })
    }

    /// File to picture, once; microseconds of pipelines that were compiled before it or in it; the material's bytes on the device.
    pub(super) fn once(&self) -> anyhow::Result<(Steps, f64, u64)> {
        let mut clock = Clock::new();
        let bytes = std::fs::read(self.path)?;
        let read = clock.lap();
        // A capture's array starts where its header ends.
        let bytes = match self.layout {
            MaterialLayout::Capture => self.entries_of(&bytes)?,
            _ => &bytes,
        };
        if let Some(timer) = &self.timer {
            return Steps::timed(timer, bytes, read);
        }
        let mut clock = Clock::new();
        let material = if self.layout == MaterialLayout::Capture { None } else { Some(parse(self.path, bytes)?) };
        let parse = clock.lap();
        let side = [self.header.width, self.header.height];
        let irradiance = vec![[1.0; 3]; (side[0] * side[1]) as usize];
        let size = side.map(|side| side.min(FRAME));
        let origin = [0, 1].map(|k| (side[k] - size[k]) / 2);
        let exitance = match &material {
            Some(material) => cpu::gather(material, &irradiance, origin, size),
            None => cpu::gather(&Entries { header: self.header, entries: bytes }, &irradiance, origin, size),
        };
        std::hint::black_box(cpu::present(&exitance, size, size, 1.0));
        let first_frame = clock.lap();
        Ok((Steps::by_cpu(read, parse, first_frame), 0.0, 0))
    }

    fn entries_of<'b>(&self, bytes: &'b [u8]) -> anyhow::Result<&'b [u8]> {
        let capture = Capture::open(self.path, &Overrides::default())?;
        let len = capture.pixels() * capture.window_len() * size_of::<f32>();
        let start = bytes.len().checked_sub(len).context("captures for timing are float32")?;
        Ok(&bytes[start..])
    }
}

/// Entries of a capture, as the CPU twin of the gather reads them.
struct Entries<'a> {
    header: BssrdfHeader,
    entries: &'a [u8],
}

impl Reflectance for Entries<'_> {
    fn header(&self) -> &BssrdfHeader {
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
