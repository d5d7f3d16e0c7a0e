//! Diffuse reflectance profiles R_d(r) of layered materials in three channels.
//!
//! Each channel is a run of its own under one grid, as in the supplement of *Separable subsurface scattering* (Jimenez et al.
//! 2015), section F.

use std::io::Write as _;
use std::path::Path;

use super::{Axes, Estimate, Grid, Layer, Outcome, Quantity, Request, Score, Source, Stack};
use crate::error::{Error, Result};
use crate::file::output::write_bytes;
use crate::progress::Progress;
use crate::simulate::diffusion::Medium;

/// Photon packets per channel where nothing else is asked for (section F).
pub const PACKETS: u64 = 10_000_000;

/// Rings to the smallest mean free path (section F).
const RINGS: f64 = 20.0;

/// Largest mean free paths that the rings reach (section F).
const REACH: f64 = 32.0;

/// Rings, at most: what section F asks for where one channel's light goes a thousand times as far as another's.
const MAX_RINGS: usize = 1 << 20;

/// Colours of the channels, as lines of totals begin.
const NAMES: [&str; 3] = ["red", "green", "blue"];
/// What stands before the share that is mirrored at the top, in these lines.
const MIRRORED: &str = "mirrored ";

/// R_d by radius or angle.
const BY_RADIUS: Score = Score { quantity: Quantity::Reflected, axes: Axes { r: true, a: false, z: false, t: false } };
const BY_ANGLE: Score = Score { quantity: Quantity::Reflected, axes: Axes { r: false, a: true, z: false, t: false } };

/// A layered material: a stack for each of the linear Rec. 709 channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    /// Stacks of red, green and blue, of as many layers each.
    pub channels: [Stack; 3],
}

/// R_d(r) and what belongs to it, in one channel.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// R_d in mm⁻² of each ring.
    pub rd: Vec<f64>,
    /// Standard errors of [`Self::rd`] in mm⁻².
    pub rd_error: Vec<f64>,
    /// Share of the light that leaves beyond the last ring.
    pub beyond: f64,
    /// R_d in sr⁻¹ of each angle from the normal.
    pub rd_of_angle: Vec<f64>,
    /// Share that leaves upwards, without what is mirrored.
    pub reflected: Estimate,
    /// Share that leaves downwards.
    pub transmitted: Estimate,
    /// Share absorbed.
    pub absorbed: Estimate,
    /// Share mirrored at the top.
    pub specular: f64,
    /// Photon packets traced.
    pub packets: u64,
}

/// Diffuse reflectance profiles of a material.
#[derive(Clone, Debug, PartialEq)]
pub struct Profiles {
    /// Width of a ring in mm; ring k is k to k + 1 of these from the axis.
    pub dr_mm: f64,
    /// Red, green and blue.
    pub channels: [Channel; 3],
}

/// What is simulated of a material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Photon packets per channel.
    pub packets: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Angles of R_d(α).
    pub angles: usize,
    /// Width of a ring in mm; `None`: a twentieth of the smallest mean free path.
    pub dr_mm: Option<f64>,
    /// Radius of the last ring in mm; `None`: 32 of the largest mean free paths.
    pub reach_mm: Option<f64>,
}

impl Default for Settings {
    fn default() -> Self {
        Self { packets: PACKETS, seed: 1, angles: 30, dr_mm: None, reach_mm: None }
    }
}

impl Material {
    /// A half-space of a medium with isotropic scattering, under air.
    #[must_use]
    pub fn half_space(medium: Medium, eta: f64) -> Self {
        let channel = |c: usize| Stack::half_space(eta, medium.sigma_a[c], medium.sigma_s[c], 0.0);
        Self { channels: std::array::from_fn(channel) }
    }

    /// Simulates the profiles.
    ///
    /// # Errors
    ///
    /// [`Error::Request`] for layers, grids or numbers of packets that cannot be simulated.
    pub fn simulate(&self, settings: &Settings, progress: &dyn Progress) -> Result<Profiles> {
        for stack in &self.channels {
            stack.check()?;
        }
        let grid = self.grid(settings)?;
        let mut channels = Vec::with_capacity(3);
        for (stack, c) in self.channels.iter().zip(0..) {
            let request = Request {
                stack: stack.clone(),
                source: Source::Pencil { z_mm: 0.0 },
                grid,
                scores: vec![BY_RADIUS, BY_ANGLE],
                packets: settings.packets,
                threshold: 1e-4,
                // Channels have noise of their own.
                seed: settings.seed.wrapping_mul(3).wrapping_add(c),
                ballistic_apart: false,
            };
            channels.push(Channel::new(&request.run(progress)?));
        }
        let channels = channels.try_into().map_err(|_| Error::Request("a material has three channels".into()))?;
        Ok(Profiles { dr_mm: grid.dr_mm, channels })
    }

    /// Rings of section F: d_r = min MFP / 20, n_r = ⌈32 max MFP / d_r⌉, MFP = 1 / (σ_a + (1 − g) σ_s) of all channels' layers.
    fn grid(&self, settings: &Settings) -> Result<Grid> {
        let layers = || self.channels.iter().flat_map(|stack| &stack.layers).filter(|layer| layer.sigma_t() > 0.0);
        let path = |layer: &Layer| 1.0 / (layer.sigma_a + (1.0 - layer.g) * layer.sigma_s);
        let shortest = layers().map(path).fold(f64::INFINITY, f64::min);
        let longest = layers().map(path).fold(0.0, f64::max);
        if longest == 0.0 && (settings.dr_mm.is_none() || settings.reach_mm.is_none()) {
            return Err(Error::Request(
                "no layer scatters or absorbs: say how wide rings are, and how far they reach".into(),
            ));
        }
        let dr_mm = settings.dr_mm.unwrap_or(shortest / RINGS);
        let rings = (settings.reach_mm.unwrap_or(REACH * longest) / dr_mm).ceil();
        #[allow(clippy::cast_precision_loss, reason = "far below 2^53")]
        if !(rings >= 1.0 && rings <= MAX_RINGS as f64) {
            return Err(Error::Request(format!(
                "{rings} rings of {dr_mm} mm, allowed are 1 to {MAX_RINGS}: take wider ones, or a shorter reach"
            )));
        }
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked above")]
        let nr = rings as usize;
        Ok(Grid { dr_mm, nr, na: settings.angles, dz_mm: 1.0, nz: 1, dt_ps: 1.0, nt: 1 })
    }
}

impl Channel {
    fn new(outcome: &Outcome) -> Self {
        let [by_radius, by_angle] =
            [BY_RADIUS, BY_ANGLE].map(|score| outcome.tally(score).expect("both were asked for"));
        let mut rd = by_radius.densities(outcome.packets);
        let mut rd_error = by_radius.standard_errors(outcome.packets);
        for (ring, error) in rd_error.iter_mut().enumerate() {
            *error /= by_radius.extent(ring).max(f64::MIN_POSITIVE);
        }
        rd.pop();
        rd_error.pop();
        Self {
            rd,
            rd_error,
            beyond: by_radius.shares(outcome.packets).last().copied().unwrap_or(0.0),
            rd_of_angle: by_angle.densities(outcome.packets),
            reflected: outcome.reflected,
            transmitted: outcome.transmitted,
            absorbed: outcome.absorbed,
            specular: outcome.specular,
            packets: outcome.packets,
        }
    }
}

impl Profiles {
    /// Writes the profiles as CSV: totals in lines that begin with `#`, then a line for each ring with its middle in mm, R_d of
    /// the three channels in mm⁻², and their standard errors.
    ///
    /// # Errors
    ///
    /// [`Error::Output`] where the system refuses.
    pub fn write_csv(&self, path: &Path) -> Result<()> {
        let mut text = Vec::new();
        self.csv(&mut text).map_err(|source| Error::Output { path: path.into(), source })?;
        write_bytes(path, &text)
    }

    fn csv(&self, out: &mut Vec<u8>) -> std::io::Result<()> {
        writeln!(out, "# diffuse reflectance R_d(r), simulated by Monte Carlo")?;
        for (channel, name) in self.channels.iter().zip(NAMES) {
            let Channel { reflected, absorbed, transmitted, specular, beyond, packets, .. } = channel;
            writeln!(
                out,
                "# {name}: {packets} photon packets; reflected {:.6} ± {:.6}, absorbed {:.6} ± {:.6}, transmitted {:.6} ± {:.6}, \
                 {MIRRORED}{specular:.6}, beyond the last ring {beyond:.6}",
                reflected.mean,
                reflected.standard_error,
                absorbed.mean,
                absorbed.standard_error,
                transmitted.mean,
                transmitted.standard_error,
            )?;
        }
        writeln!(out, "r_mm,rd_red,rd_green,rd_blue,error_red,error_green,error_blue")?;
        for ring in 0..self.channels[0].rd.len() {
            #[allow(clippy::cast_precision_loss, reason = "rings are at most 2^20")]
            let r_mm = (ring as f64 + 0.5) * self.dr_mm;
            write!(out, "{r_mm:.6e}")?;
            for value in self.channels.iter().map(|channel| channel.rd[ring]) {
                write!(out, ",{value:.6e}")?;
            }
            for value in self.channels.iter().map(|channel| channel.rd_error[ring]) {
                write!(out, ",{value:.3e}")?;
            }
            writeln!(out)?;
        }
        Ok(())
    }
}

/// Shares of red, green and blue that are mirrored at the top, as [`Profiles::write_csv`] tells them; 0 where a text does not.
pub(crate) fn mirrored(csv: &str) -> [f64; 3] {
    let of = |name: &str| {
        let totals = csv.lines().find(|line| line.starts_with(&format!("# {name}: ")))?;
        let share: f64 = totals.split_once(MIRRORED)?.1.split(',').next()?.parse().ok()?;
        (0.0..1.0).contains(&share).then_some(share)
    };
    NAMES.map(|name| of(name).unwrap_or(0.0))
}

/// Lines that tell [`mirrored`] its shares.
pub(crate) fn mirrored_lines(shares: [f64; 3]) -> String {
    let lines = NAMES.iter().zip(shares).map(|(name, share)| format!("{name}: {MIRRORED}{share:.6}"));
    lines.collect::<Vec<_>>().join("\n")
}
