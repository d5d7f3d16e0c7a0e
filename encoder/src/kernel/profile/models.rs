//! Profiles in closed form, to compare with simulated ones.

use super::{Profile, Radial};
use crate::error::{Error, Result};
use crate::simulate::burley::NormalisedDiffusion;
use crate::simulate::diffusion::Medium;
use crate::simulate::diffusion::analytic::HalfSpace;

/// Share of a channel's light beyond the last ring.
const BEYOND: f64 = 1e-5;
/// Rings.
const RINGS: u32 = 1_024;

impl Profile {
    /// The dipole of a half-space (Jensen et al. 2001): diffusion from a source and its image.
    ///
    /// # Errors
    ///
    /// [`Error::Request`] where a channel does not scatter or does not absorb.
    pub fn dipole(medium: &Medium, eta: f64) -> Result<Self> {
        for ((sigma_a, sigma_s), name) in medium.sigma_a.iter().zip(&medium.sigma_s).zip(["red", "green", "blue"]) {
            if !(*sigma_a > 0.0 && *sigma_s > 0.0) {
                return Err(Error::Request(format!(
                    "σ_a {sigma_a} and σ_s {sigma_s} per mm in {name}; expected media that scatter and absorb, both more than 0"
                )));
            }
        }
        Self::of_tails(|c, d| HalfSpace { sigma_s: medium.sigma_s[c], sigma_a: medium.sigma_a[c], eta }.dipole_tail(d))
    }

    /// Normalised diffusion (Burley 2015) of given albedos, with the mean free paths of a medium.
    ///
    /// # Errors
    ///
    /// [`Error::Request`] for albedos that are none.
    pub fn normalised_diffusion(albedo: [f64; 3], medium: &Medium) -> Result<Self> {
        Self::of_tails(|c, d| {
            NormalisedDiffusion { albedo: albedo[c], mean_free_path_mm: medium.mean_free_path_mm(c) }.tail(d)
        })
    }

    /// The profile of T(d) of channel c at d in mm.
    fn of_tails(tail: impl Fn(usize, f64) -> f64) -> Result<Self> {
        let mut channels = Vec::with_capacity(3);
        for c in 0..3 {
            let total = tail(c, 0.0);
            // Doubled until hardly any light is beyond; some media never get there.
            let mut radius = 1e-3;
            while tail(c, radius) > BEYOND * total && radius < 1e6 {
                radius *= 2.0;
            }
            if !(total > 0.0 && total <= 1.0 && radius < 1e6) {
                return Err(Error::Request(format!(
                    "a reflectance of {total} as far as {radius} mm; expected media that scatter and absorb"
                )));
            }
            channels.push(Radial::of_tail(radius, RINGS, |d| tail(c, d)));
        }
        Ok(Self { channels: std::array::from_fn(|c| channels[c].clone()) })
    }
}
