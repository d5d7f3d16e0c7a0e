//! Diffuse reflectance profiles R_d(r) of homogeneous materials, in three channels.

mod artist;
mod base;
mod csv;
mod models;
mod points;
mod radial;
pub mod shipped;

use std::path::Path;

use subsurf_decoder::kernel::TwoGaussians;

pub(super) use artist::check as check_two_gaussians;
pub use base::of_base;
pub use radial::Radial;

use crate::error::{Error, Result};
use crate::simulate::monte_carlo::mcml;
use crate::simulate::monte_carlo::profile::Profiles;

/// Width of rings by their inner radius: finer ones hold more noise than shape.
const GROWTH: f64 = 0.05;
/// What a reflectance of 1 may be too large by: profiles add up in rounded numbers.
const ROUNDING: f64 = 1e-6;

/// R_d(r) in mm⁻² of red, green and blue: radiant exitance per radiant flux that *entered*, Fresnel transmission on the way in not
/// included.
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    /// Red, green and blue; each has rings of its own.
    pub channels: [Radial; 3],
}

impl Profile {
    /// The profile of a file: a `.csv` of radii and R_d, or MCML's `.mco`, which has one channel.
    ///
    /// In a `.csv`, lines of `#` and a title are passed over; columns are r in mm and R_d in mm⁻² of red, green and blue, or of
    /// all; more columns mean nothing. Rows at the middles of equal rings, as `simulate profile` writes them, are rings; two
    /// columns of radii with the titles `r_from_mm` and `r_to_mm` are those of any rings; other rows are points, between
    /// which R_d falls exponentially. What is negative is noise, and becomes 0.
    ///
    /// MCML and `simulate profile` give R_d per flux that was sent, and say which share R_sp the surface mirrored: it is divided by
    /// 1 − R_sp. Any other table is taken as it is, and has to be per flux that entered.
    ///
    /// # Errors
    ///
    /// [`Error::Input`] that names the line, what stands there and what is expected.
    pub fn read(path: &Path) -> Result<Self> {
        let is_mco = path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("mco"));
        if !is_mco {
            return csv::read(path)?.checked(&|found, expected| Error::input(path, found, expected));
        }
        let (dr_mm, rd, mirrored) = mcml::read_rd(path)?;
        let radial = rings(dr_mm, &rd).scaled(entered(mirrored));
        Self { channels: [radial.clone(), radial.clone(), radial] }
            .checked(&|found, expected| Error::input(path, found, expected))
    }

    /// The profile of three channels, each of a file of its own: its red of the first, green of the second, blue of the third.
    ///
    /// # Errors
    ///
    /// As [`Self::read`].
    pub fn read_channels(paths: [&Path; 3]) -> Result<Self> {
        let mut files = Vec::with_capacity(3);
        for path in paths {
            files.push(Self::read(path)?);
        }
        Ok(Self { channels: std::array::from_fn(|c| files[c].channels[c].clone()) })
    }

    /// The profile that was simulated, what left beyond the rings within them; simulations count per flux that was sent.
    ///
    /// # Errors
    ///
    /// [`Error::Request`] where nothing came back in a channel.
    pub fn simulated(profiles: &Profiles) -> Result<Self> {
        let channel = |c: usize| {
            let simulated = &profiles.channels[c];
            let radial = rings(profiles.dr_mm, &simulated.rd);
            let inside = radial.energy();
            let all = if inside > 0.0 { (inside + simulated.beyond) / inside } else { 1.0 };
            radial.scaled(all * entered(simulated.specular))
        };
        Self { channels: std::array::from_fn(channel) }
            .checked(&|found, _| Error::Request(format!("{found}; trace more photons")))
    }

    /// The profile w G(τ_near) + (1 − w) G(τ_far) in the plane, of a given reflectance: along an axis it is the artist's (section E).
    ///
    /// # Errors
    ///
    /// [`Error::Request`] for numbers that are none.
    pub fn of_two_gaussians(two: &TwoGaussians, reflectance: [f32; 3]) -> Result<Self> {
        artist::check(two)?;
        let channel = |c: usize| artist::radial(two, reflectance, c);
        Self { channels: std::array::from_fn(channel) }.checked(&|found, expected| {
            Error::Request(format!("two Gaussians and a reflectance: {found}; expected {expected}"))
        })
    }

    /// ‖R_d‖₁ `[rgb]`.
    #[must_use]
    pub fn reflectance(&self) -> [f64; 3] {
        self.channels.each_ref().map(Radial::energy)
    }

    /// The profile with a given reflectance.
    #[must_use]
    pub fn with_reflectance(&self, reflectance: [f64; 3]) -> Self {
        let channel = |c: usize| self.channels[c].scaled(reflectance[c] / self.channels[c].energy());
        Self { channels: std::array::from_fn(channel) }
    }

    /// The profile in rings of which each is a twentieth of its radius wide, or as wide as it was.
    #[must_use]
    pub fn condensed(&self) -> Self {
        Self { channels: self.channels.each_ref().map(|channel| channel.condensed(GROWTH)) }
    }

    /// The profile, each channel as far as it reaches but for a thousandth of its light, which is moved within.
    pub(crate) fn limited(&self) -> Result<Self> {
        let mut channels = self.channels.clone();
        for (radial, name) in channels.iter_mut().zip(["red", "green", "blue"]) {
            let energy = radial.energy();
            if !(energy > 0.0 && energy <= 1.0 + ROUNDING) {
                return Err(Error::Request(format!(
                    "R_d adds up to {energy:.4} in {name}; expected a reflectance up to 1: are radii in mm and R_d in mm⁻²? Say what the reflectance is, if not"
                )));
            }
            let refuse =
                |(found, expected): (String, String)| Error::Request(format!("{found} in {name}; expected {expected}"));
            *radial = radial.limited().map_err(refuse)?.scaled(1.0 / radial.energy().max(1.0));
        }
        Ok(Self { channels })
    }

    /// The profile, if there is light in every channel.
    fn checked(self, refuse: &dyn Fn(String, &str) -> Error) -> Result<Self> {
        for (channel, name) in self.channels.iter().zip(["red", "green", "blue"]) {
            let energy = channel.energy();
            if !(energy > 0.0 && energy.is_finite()) {
                return Err(refuse(format!("R_d that adds up to {energy} in {name}"), "some light in every channel"));
            }
        }
        Ok(self)
    }
}

/// Flux that was sent by what entered, where the surface mirrored the share `mirrored`.
fn entered(mirrored: f64) -> f64 {
    1.0 / (1.0 - mirrored)
}

/// Rings of one width; what is negative is 0.
fn rings(dr_mm: f64, rd: &[f64]) -> Radial {
    #[allow(clippy::cast_precision_loss, reason = "rings are at most 2^20")]
    let edges = (0..=rd.len()).map(|k| k as f64 * dr_mm).collect();
    Radial::new(edges, rd.iter().map(|rd| rd.max(0.0)).collect())
}
