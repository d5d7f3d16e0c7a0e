//! A simulated capture from request to file.

use std::ops::RangeInclusive;
use std::path::Path;

use serde_json::{Value, json};
use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::bssrdf::layout::LENGTHS_MM;

use super::medium::Medium;
use super::run::{Finish, Summary, complete, simulate};
use super::slab::{MediumMap, Slab};
use crate::capture::{CaptureWriter, Scalar, Sidecar};
use crate::error::{Error, Result};
use crate::file::output::expect_space;
use crate::memory;
use crate::progress::Progress;
use crate::simulate::monte_carlo::voxels;

/// How much finer or coarser than usual voxels may be.
const REFINE: RangeInclusive<f64> = 0.1..=16.0;
/// Refractive indices that can be simulated.
const ETA: RangeInclusive<f64> = 1.0..=4.0;
/// Pixels to a side of a window, at most.
const MAX_WINDOW: u32 = 2_047;
/// Pixels to a side of a patch, at most.
const MAX_SIDE: usize = 65_535;
/// Thickness of a slab in mm, at most: light gets nowhere near that deep.
const MAX_THICKNESS_MM: f64 = 10_000.0;
/// Voxels around a pixel, at most.
const MAX_VOXELS: usize = 8_000_000;
/// Bytes of memory for a voxel, on every core.
const BYTES_OF_VOXEL: usize = 200;

/// Refuses refractive indices that cannot be simulated.
pub(super) fn check_eta(eta: f64) -> Result<()> {
    match ETA.contains(&eta) {
        true => Ok(()),
        false => Err(Error::Request(format!("--eta is {eta}; refractive indices are 1 to 4"))),
    }
}

fn check_sides(size: [usize; 2], window: u32) -> Result<()> {
    if window.is_multiple_of(2) || window > MAX_WINDOW {
        return Err(Error::Request(format!("--window is {window}; it must be odd and at most {MAX_WINDOW}")));
    }
    match size.iter().any(|side| *side > MAX_SIDE) {
        true => Err(Error::Request(format!("--size is {}x{}; the limit is {MAX_SIDE} pixels", size[0], size[1]))),
        false => Ok(()),
    }
}

/// Whether a patch of this size, in pixels, and with this window fits into memory while it is simulated, and its array
/// beside `output`. It needs no media.
///
/// # Errors
/// [`Error::Request`] with what it would take.
pub fn check_patch(size: [usize; 2], window: u32, output: &Path) -> Result<()> {
    check_sides(size, window)?;
    let [width, height] = size.map(|side| side as u64);
    let row = width * u64::from(window).pow(2) * 3 * size_of::<f32>() as u64;
    // Rows that are simulated together, one that is finished, and the medium of every pixel.
    let rows = 2 * rayon::current_num_threads() as u64 + 1;
    let media = width * height * size_of::<Medium>() as u64;
    let what = || format!("--size {width}x{height} with --window {window}");
    memory::expect(media.saturating_add(row.saturating_mul(rows)), what)?;
    // What is solved, in single precision, and the array.
    expect_space(output, row.saturating_mul(2 * height), what)
}

/// How light in a slab is simulated.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Method {
    /// As diffusion: fast and without noise, wrong near the beam and where little is scattered.
    #[default]
    Diffusion,
    /// By photon packets: with noise, and nothing else wrong.
    MonteCarlo {
        /// Packets for each pixel and channel.
        packets: u64,
    },
}

/// A capture to be simulated and written.
#[derive(Clone, Debug)]
pub struct Request<'a> {
    /// How it is simulated.
    pub method: Method,
    /// Media of all pixels.
    pub map: &'a MediumMap,
    /// What the media are made from, for the sidecar.
    pub source: Value,
    /// What lies beyond the border.
    pub addressing: Addressing,
    /// Distance of neighbouring pixels in mm.
    pub pitch_mm: f64,
    /// Pixels to a side of the window in which light is measured, D; odd.
    pub window: u32,
    /// Thickness of the slab in mm.
    pub thickness_mm: f64,
    /// Refractive index, 1 to 4.
    pub eta: f64,
    /// Factor by which voxels of diffusion are finer than usual, 0.1 to 16.
    pub refine: f64,
    /// What becomes of the solutions.
    pub finish: Finish,
    /// Seed of the photons, and of the pattern, for the sidecar.
    pub seed: u64,
    /// Element type of the array.
    pub scalar: Scalar,
}

impl Request<'_> {
    /// Whether it can be simulated.
    ///
    /// # Errors
    /// [`Error::Request`] for what is out of range, by the names that the command has for it.
    pub fn check(&self) -> Result<()> {
        let refuse = |message: String| Err(Error::Request(message));
        let photons = self.finish.sensor.map_or(1.0, |sensor| sensor.photons);
        for (what, value) in [("pitch", self.pitch_mm), ("thickness", self.thickness_mm), ("noise", photons)] {
            if !(value.is_finite() && value > 0.0) {
                return refuse(format!("--{what} is {value}; it must be positive"));
            }
        }
        if self.thickness_mm > MAX_THICKNESS_MM {
            let thickness = self.thickness_mm;
            return refuse(format!("--thickness is {thickness} mm; at most {MAX_THICKNESS_MM} mm can be simulated"));
        }
        let [shortest, longest] = LENGTHS_MM.map(f64::from);
        if !(shortest..=longest).contains(&self.pitch_mm) {
            return refuse(format!("--pitch is {} mm; from {shortest} to {longest} will do", self.pitch_mm));
        }
        if !REFINE.contains(&self.refine) {
            let (least, most) = (REFINE.start(), REFINE.end());
            return refuse(format!("--refine is {}; it may be {least} to {most}", self.refine));
        }
        check_eta(self.eta)?;
        check_sides(self.map.size, self.window)?;
        if let Method::MonteCarlo { packets } = self.method {
            if !(1..=voxels::MAX_PACKETS).contains(&packets) {
                let most = voxels::MAX_PACKETS;
                return refuse(format!("--photons is {packets}; each pixel and channel takes 1 to {most}"));
            }
            // All windows at once.
            let [width, height] = self.map.size.map(|side| side as u64);
            let bytes = (width * height).saturating_mul(u64::from(self.window).pow(2) * 3 * size_of::<f32>() as u64);
            return memory::expect(bytes, || format!("--method monte-carlo of {width}x{height} pixels"));
        }
        let voxels = self.slab().voxels();
        if voxels > MAX_VOXELS {
            return refuse(format!(
                "this takes {voxels} voxels around every pixel, more than {MAX_VOXELS}: a smaller --window or --refine \
                 takes fewer, and so does a --pitch nearer to the mean free path of light"
            ));
        }
        let bytes = (voxels * BYTES_OF_VOXEL) as u64 * rayon::current_num_threads() as u64;
        memory::expect(bytes, || format!("a simulation of {voxels} voxels on each of all threads"))
    }

    fn slab(&self) -> Slab<'_> {
        Slab {
            map: self.map,
            addressing: self.addressing,
            pitch_mm: self.pitch_mm,
            radius: self.window as usize / 2,
            thickness_mm: self.thickness_mm,
            eta: self.eta,
            refine: self.refine,
        }
    }

    /// Simulates, and writes array and sidecar.
    ///
    /// # Errors
    /// As [`Self::check`], [`check_patch`] and [`simulate`].
    pub fn write(&self, path: &Path, progress: &dyn Progress) -> Result<Summary> {
        self.check()?;
        check_patch(self.map.size, self.window, path)?;
        let slab = self.slab();
        let writer =
            |sidecar| CaptureWriter { path, size: self.map.size, radius: slab.radius, scalar: self.scalar, sidecar };
        let Method::MonteCarlo { packets } = self.method else {
            return simulate(&slab, &self.finish, &writer(&self.sidecar()), progress);
        };
        let measured = voxels::measure(&slab, voxels::Settings { packets, seed: self.seed }, progress);
        // A run that was stopped says how much it is of.
        let done = Request { method: Method::MonteCarlo { packets: measured.packets }, ..self.clone() };
        complete(&slab, &self.finish, &writer(&done.sidecar()), |sink| {
            sink(&measured.windows).map(|()| measured.window_share)
        })
    }

    /// The sidecar of the capture, which says that it is simulated and how.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "lengths and indices need no more than f32")]
    pub fn sidecar(&self) -> Sidecar {
        let mut simulated = json!({
            "by": concat!("subsurf ", env!("CARGO_PKG_VERSION")),
            "source": self.source,
            "thickness_mm": self.thickness_mm,
            "seed": self.seed,
            "reciprocal": !self.finish.one_way,
            "photons": self.finish.sensor.map(|sensor| sensor.photons),
            "refine": self.refine,
        });
        if let Method::MonteCarlo { packets } = self.method {
            simulated["method"] = "monte-carlo".into();
            simulated["packets"] = packets.into();
        }
        Sidecar {
            pitch_mm: self.pitch_mm as f32,
            addressing: self.addressing,
            eta: self.eta as f32,
            simulated: Some(simulated),
        }
    }
}
