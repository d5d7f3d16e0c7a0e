//! Loads a capture, or a file of a translucent material: read, parsed, uploaded, drawn once.

use std::path::Path;

use anyhow::Context;
use subsurf_cli::info::parse;
use subsurf_decoder::bssrdf::layout::MODEL_2BMPP;
use subsurf_decoder::bssrdf::{BssrdfHeader, Coding};
use subsurf_encoder::capture::{Capture, Overrides};
use subsurf_runtime::{Gpu, MaterialLayout, layout_of};
use subsurf_shaders::Rgb;
use subsurf_shaders::cpu::{self, Reflectance};
use subsurf_viewer::{Loader, Stored};

use super::results::Steps;
use crate::bench::timing::Clock;

/// Pixels to a side of the first frame.
const FRAME: u32 = 64;

/// What the header says, and how the device will hold it.
pub(super) fn describe(path: &Path, is_capture: bool) -> anyhow::Result<(BssrdfHeader, MaterialLayout)> {
    if is_capture {
        let capture = Capture::open(path, &Overrides::default())?;
        return Ok((header_of(&capture)?, MaterialLayout::Capture));
    }
    let bytes = std::fs::read(path)?;
    let material = parse(path, &bytes)?;
    Ok((*material.header(), layout_of(&material)))
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
    loader: Option<Loader<'a>>,
}

impl<'a> FileLoader<'a> {
    /// Compiles what an application has before it loads its first material.
    pub(super) fn new(
        gpu: Option<&'a Gpu>,
        path: &'a Path,
        header: BssrdfHeader,
        layout: MaterialLayout,
    ) -> anyhow::Result<Self> {
        let stored = match layout {
            MaterialLayout::Capture => Stored::Capture(header),
            layout => Stored::Planes(layout),
        };
        Ok(Self { path, header, layout, loader: gpu.map(|gpu| Loader::new(gpu, stored)).transpose()? })
    }

    /// File to picture, once; and the material's bytes on the device.
    pub(super) fn once(&self) -> anyhow::Result<(Steps, u64)> {
        let mut clock = Clock::new();
        let bytes = std::fs::read(self.path)?;
        let read = clock.lap();
        // A capture's array starts where its header ends.
        let bytes = match self.layout {
            MaterialLayout::Capture => self.entries_of(&bytes)?,
            _ => &bytes,
        };
        if let Some(loader) = &self.loader {
            let loading = loader.load(bytes)?;
            return Ok((Steps::of(read, &loading), loading.gpu_bytes));
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
        Ok((Steps { read, parse, upload: 0.0, first_frame, total: read + parse + first_frame }, 0))
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
