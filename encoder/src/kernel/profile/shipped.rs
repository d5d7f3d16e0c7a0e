//! Profiles of the measured materials that come with the library, and how they are made.

use std::path::Path;

use super::{Profile, csv};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::simulate::diffusion::Medium;
use crate::simulate::monte_carlo::profile::{Material, Settings, mirrored_lines};

/// Decay lengths 1/σ_tr that the rings reach at least: far from the light a profile falls exponentially, and beyond eight of them
/// there is less than 10⁻⁴ of the light.
const DECAY_LENGTHS: f64 = 8.0;
/// Largest mean free paths that the rings reach at least (Jimenez et al. 2015, section F).
const PATHS: f64 = 32.0;

macro_rules! shipped {
    ($($name:literal),*) => {
        /// Names and tables.
        const SHIPPED: &[(&str, &str)] =
            &[$(($name, include_str!(concat!("../../../profiles/", $name, ".csv")))),*];
    };
}

shipped!(
    "apple",
    "chicken1",
    "chicken2",
    "cream",
    "ketchup",
    "marble",
    "potato",
    "skimmilk",
    "skin1",
    "skin2",
    "wholemilk"
);

/// Names of the materials whose profiles come with the library: those of Jimenez et al. 2015, section G.
pub fn names() -> impl Iterator<Item = &'static str> {
    SHIPPED.iter().map(|(name, _)| *name)
}

/// Profile of the material of that name, if it comes with the library.
#[must_use]
pub fn profile(name: &str) -> Option<Profile> {
    let (name, text) = SHIPPED.iter().find(|(known, _)| known.eq_ignore_ascii_case(name))?;
    Some(csv::parse(Path::new(name), text).expect("a table that the tests read"))
}

/// Simulates a measured material of refractive index `eta` as the shipped profiles were: section F's photons and width of rings, rings that reach 32 of the
/// largest mean free paths or eight of the longest decay lengths. Returns the profile and its
/// table, which is per flux that was sent and tells what the surface mirrored.
///
/// # Errors
///
/// [`Error::Request`] if no material has that name, or light in it never decays; those of [`Material::simulate`].
pub fn simulate(name: &str, eta: f64, packets: u64, progress: &dyn Progress) -> Result<(Profile, String)> {
    let medium = Medium::measured(name).ok_or_else(|| Error::Request(format!("no material is called {name}")))?;
    let decay = (0..3).map(|c| medium.decay_length_mm(c)).fold(0.0, f64::max);
    if decay.is_infinite() {
        return Err(Error::Request(format!(
            "{name} does not absorb: light in it goes any distance, and no kernel has it"
        )));
    }
    let path = (0..3).map(|c| medium.mean_free_path_mm(c)).fold(0.0, f64::max);
    let reach_mm = (DECAY_LENGTHS * decay).max(PATHS * path);
    let settings = Settings { packets, reach_mm: Some(reach_mm), ..Settings::default() };
    let simulated = Material::half_space(medium, eta).simulate(&settings, progress)?;
    let profile = Profile::simulated(&simulated)?.condensed();
    let traced = simulated.channels.each_ref().map(|channel| channel.packets.to_string());
    let shares = simulated.channels.each_ref().map(|channel| channel.specular);
    let comment = format!(
        "{name}: diffuse reflectance R_d in mm⁻² per flux that was sent, of rings in mm, simulated by Monte Carlo\n\
         σ_a {:?}, σ_s {:?} in mm⁻¹, η {eta}, g 0, half-infinite; {} photon packets, seed {}\n{}",
        medium.sigma_a,
        medium.sigma_s,
        traced.join(", "),
        settings.seed,
        mirrored_lines(shares)
    );
    let sent = std::array::from_fn(|c| profile.channels[c].scaled(1.0 - shares[c]));
    let table = csv::write(&Profile { channels: sent }, &comment);
    Ok((profile, table))
}
