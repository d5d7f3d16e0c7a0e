//! Timed loads: from the bytes of a file to its first frame, step by step. Benchmarks and tests on every system share it.

use std::time::Duration;

use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_decoder::{Bssrdf, Content, File};
use subsurf_shaders::{BtfLayout, MaterialLayout};
use web_time::Instant;

use super::first_frame::{Stage, gathered};
use super::steps::Load;
use super::stored::{RawImages, Stored, capture_bytes, expect_length};
use super::work::LoadPhase;
use crate::asset::{BssrdfPlanes, Material};
use crate::error::Result;
use crate::gpu::Gpu;
use crate::technique::{PatchRenderer, Technique};

/// Load of one file: how long each phase took, and what the device holds then.
#[derive(Clone, Copy, Debug, Default)]
pub struct LoadTimes {
    /// All checks, CRCs included.
    pub parse: Duration,
    /// Onto the device, until it has everything.
    pub upload: Duration,
    /// Pipelines that the load compiled: none but at the first load of a kind.
    pub pipelines: Duration,
    /// Passes of the projection, recorded and submitted: what the CPU does of it where the device is none.
    pub recording: Duration,
    /// Projection from its beginning until the device has done it.
    pub projection: Duration,
    /// First frame of 64 × 64 pixels at most, until it is done.
    pub first_frame: Duration,
    /// Bytes of the material on the device.
    pub gpu_bytes: u64,
}

/// What an application has before it loads its first material: pipelines of frames, and a mesh.
pub struct LoadTimer<'a> {
    gpu: &'a Gpu,
    ready: Ready,
    compiled: Duration,
}

/// Pipelines of the first frame, and what is loaded for them.
enum Ready {
    /// Flat patch: planes of a file, or a capture if there is a header for it.
    Patch(PatchRenderer, Option<BssrdfHeader>),
    /// Mesh: a file for a technique.
    File(Stage, Technique),
    /// Mesh: images of a BTF.
    Images(Stage, RawImages),
}

impl LoadTimes {
    /// Work of the CPU besides pipelines until the material can be drawn: parse, upload, recording.
    #[must_use]
    pub fn cpu(&self) -> Duration {
        self.parse + self.upload + self.recording
    }

    /// Time besides pipelines until the material can be drawn: parse, upload, projection.
    #[must_use]
    pub fn drawable(&self) -> Duration {
        self.parse + self.upload + self.projection
    }
}

impl<'a> LoadTimer<'a> {
    /// Compiles the pipelines of frames.
    ///
    /// # Errors
    /// The device cannot draw it.
    pub fn new(gpu: &'a Gpu, stored: Stored) -> Result<Self> {
        let begin = Instant::now();
        let ready = match stored {
            Stored::Planes(layout) => Ready::Patch(PatchRenderer::new(gpu, layout)?, None),
            Stored::Capture(header) => Ready::Patch(PatchRenderer::new(gpu, MaterialLayout::Capture)?, Some(header)),
            Stored::File(technique) => Ready::File(Stage::new(gpu, technique)?, technique),
            #[cfg(feature = "transfer")]
            Stored::Transfer(mesh) => Ready::File(Stage::on(gpu, Technique::Transfer, &mesh)?, Technique::Transfer),
            Stored::Images(images) => Ready::Images(Stage::new(gpu, Technique::Btf(BtfLayout::Images))?, images),
        };
        Ok(Self { gpu, ready, compiled: begin.elapsed() })
    }

    /// Time that the pipelines of frames took.
    #[must_use]
    pub fn compiled(&self) -> Duration {
        self.compiled
    }

    /// Loads a file, once.
    ///
    /// # Errors
    /// The bytes are not what they should be, or the device has no room for them.
    pub fn load(&self, bytes: &[u8]) -> Result<LoadTimes> {
        let gpu = self.gpu;
        let mut times = LoadTimes::default();
        match &self.ready {
            Ready::Patch(renderer, capture) => {
                let planes = match capture {
                    None => {
                        let file = timed(&mut times.parse, || Ok(Bssrdf::parse(bytes)?))?;
                        timed(&mut times.upload, || uploaded(gpu, BssrdfPlanes::upload(gpu, &file)))?
                    }
                    Some(header) => {
                        // There is nothing to check in an array but its length.
                        timed(&mut times.parse, || expect_length(bytes, capture_bytes(header)))?;
                        let upload = || uploaded(gpu, BssrdfPlanes::upload_capture(gpu, header, bytes));
                        timed(&mut times.upload, upload)?
                    }
                };
                times.gpu_bytes = planes.gpu_bytes();
                timed(&mut times.first_frame, || gathered(gpu, renderer, &planes))?;
            }
            Ready::Images(stage, images) => {
                timed(&mut times.parse, || expect_length(bytes, images.bytes()))?;
                let material = timed(&mut times.upload, || uploaded(gpu, images.upload(gpu, bytes)))?;
                times.gpu_bytes = material.gpu_bytes();
                timed(&mut times.first_frame, || stage.draw(gpu, &material))?;
            }
            Ready::File(stage, technique) => {
                let file = timed(&mut times.parse, || Ok(File::parse(bytes)?))?;
                let load = match (technique, file.content()) {
                    (Technique::Splat(_), Content::Bssrdf(material)) => {
                        timed(&mut times.upload, || Load::splat(gpu, &material))?.map(Material::Splat)
                    }
                    _ => timed(&mut times.upload, || Load::new(gpu, &file))?,
                };
                let material = load.finish_timed(&mut times)?;
                times.gpu_bytes = material.gpu_bytes();
                timed(&mut times.first_frame, || stage.draw(gpu, &material))?;
            }
        }
        Ok(times)
    }
}

impl<M> Load<'_, M> {
    /// Does what is left, and tells how long each phase took and what the device did of it; unlike [`Load::finish`] it waits for
    /// the device after every phase.
    ///
    /// # Errors
    /// As [`Load::finish`].
    pub fn finish_timed(mut self, times: &mut LoadTimes) -> Result<M> {
        while let Some(phase) = self.phase() {
            let begin = Instant::now();
            self.step()?;
            let worked = begin.elapsed();
            if self.phase() != Some(phase) {
                self.gpu().finish()?;
            }
            let done = begin.elapsed();
            match phase {
                LoadPhase::Upload => times.upload += done,
                LoadPhase::Pipelines => times.pipelines += done,
                LoadPhase::Projection => {
                    times.recording += worked;
                    times.projection += done;
                }
            }
        }
        self.finish()
    }
}

/// What was made, once the device has everything.
fn uploaded<T>(gpu: &Gpu, made: Result<T>) -> Result<T> {
    let made = made?;
    gpu.finish()?;
    Ok(made)
}

/// Adds how long something takes to a phase.
fn timed<T>(phase: &mut Duration, work: impl FnOnce() -> Result<T>) -> Result<T> {
    let begin = Instant::now();
    let made = work();
    *phase += begin.elapsed();
    made
}
