//! Loads a capture, or a file of a translucent material: read, parsed, uploaded, drawn once.

use std::path::Path;

use anyhow::Context;
use subsurf_cli::info::parse;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::layout::MODEL_2BMPP;
use subsurf_decoder::bssrdf::{BssrdfHeader, Coding};
use subsurf_encoder::capture::{Capture, Overrides};
use subsurf_runtime::{BssrdfPlanes, Gpu, MaterialLayout, PatchLight, PatchRenderer, Region, layout_of};
use subsurf_shaders::Rgb;
use subsurf_shaders::cpu::{self, Reflectance};

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
    gpu: Option<&'a Gpu>,
    path: &'a Path,
    header: BssrdfHeader,
    layout: MaterialLayout,
    /// What an application has before it loads its first material: pipelines, and light.
    renderer: Option<PatchRenderer>,
    irradiance: Vec<Rgb>,
    region: Region,
}

impl<'a> FileLoader<'a> {
    /// Compiles what an application has before it loads its first material.
    pub(super) fn new(
        gpu: Option<&'a Gpu>,
        path: &'a Path,
        header: BssrdfHeader,
        layout: MaterialLayout,
    ) -> anyhow::Result<Self> {
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
    pub(super) fn once(&self) -> anyhow::Result<(Steps, u64)> {
        let mut clock = Clock::new();
        let bytes = std::fs::read(self.path)?;
        let read = clock.lap();

        // A capture's array starts where its header ends; there is nothing else to check.
        let entries = match self.layout {
            MaterialLayout::Capture => Some(self.entries_of(&bytes)?),
            _ => None,
        };
        let material = if entries.is_none() { Some(parse(self.path, &bytes)?) } else { None };
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

    fn upload(&self, gpu: &Gpu, material: Option<&Bssrdf<'_>>, entries: &[u8]) -> anyhow::Result<BssrdfPlanes> {
        Ok(match material {
            Some(material) => BssrdfPlanes::upload(gpu, material)?,
            None => BssrdfPlanes::upload_capture(gpu, &self.header, entries)?,
        })
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
