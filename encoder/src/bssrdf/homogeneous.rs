//! Files of one base material everywhere, from a diffuse reflectance profile.

use std::f64::consts::SQRT_2;

use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, Coding, Mixture};

use super::write::{mixtures, profiles, write_file};
use crate::error::{Error, Result};
use crate::kernel::Profile;
use crate::kernel::profile::Radial;

/// Base materials of a pixel: K.
const MODEL: u8 = 1;
/// Nodes to a pixel's width.
const NODES: f64 = 2.0;
/// R_d in mm⁻² where there is none.
const NONE: f64 = 1e-30;

/// Size of a homogeneous patch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HomogeneousPatch {
    /// Pixels to a side; it repeats.
    pub side: u32,
    /// Radius of the window in pixels, 1 to 511.
    pub radius: u16,
    /// Width of a pixel in mm.
    pub pitch_mm: f32,
    /// Refractive index of the material against air.
    pub eta: f32,
}

/// A `.subsurf` file (K = 1) in which every pixel has the profile: its means over pixels, as a capture of that pitch would have them, scaled so
/// that all of its light leaves within the window.
///
/// # Errors
///
/// [`Error::Request`] for a patch without pixels, a window too wide, a pitch that is no length, or a profile without light in the window.
pub fn homogeneous(profile: &Profile, patch: &HomogeneousPatch) -> Result<Vec<u8>> {
    let HomogeneousPatch { side, radius, pitch_mm, eta } = *patch;
    if side == 0 || !(1..=511).contains(&radius) || !(pitch_mm.is_finite() && pitch_mm > 0.0) {
        return Err(Error::Request(format!(
            "a patch of {side} pixels of {pitch_mm} mm and a window of radius {radius}; expected pixels, a length and 1 to 511"
        )));
    }
    let pitch = f64::from(pitch_mm);
    let reach = f64::from(radius) * SQRT_2 * pitch * 1.000_01;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "fewer than 4,096")]
    let samples = (f64::from(radius) * SQRT_2 * NODES).ceil() as u16 + 1;
    let step = reach / f64::from(samples - 1);
    let mut nodes = Vec::with_capacity(3);
    for (radial, name) in profile.channels.iter().zip(["red", "green", "blue"]) {
        let logs: Vec<f64> =
            (0..samples).map(|h| pixel_mean(radial, f64::from(h) * step, pitch).max(NONE).ln()).collect();
        // Between nodes logarithms are linear, in files as here.
        let rd = |r: f64| {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a node")]
            let node = ((r / step) as usize).min(logs.len() - 2);
            #[allow(clippy::cast_precision_loss, reason = "a node")]
            let part = r / step - node as f64;
            (logs[node] + part * (logs[node + 1] - logs[node])).exp()
        };
        let window = -i32::from(radius)..=i32::from(radius);
        let pixels = window.clone().flat_map(|y| window.clone().map(move |x| f64::from(x).hypot(f64::from(y)) * pitch));
        let within: f64 = pixels.map(rd).sum::<f64>() * pitch * pitch;
        let factor = radial.energy() / within;
        if !(factor.is_finite() && factor < 1e6) {
            return Err(Error::Request(format!(
                "no light leaves within {reach} mm in {name}; expected a larger window"
            )));
        }
        nodes.push(logs.into_iter().map(|log| log + factor.ln()).collect::<Vec<f64>>());
    }
    #[allow(clippy::cast_possible_truncation, reason = "as files have it")]
    let values = (0..usize::from(samples)).flat_map(|h| [0, 1, 2].map(|c| nodes[c][h] as f32));
    #[allow(clippy::cast_possible_truncation, reason = "as files have it")]
    let r_max_mm = reach as f32;
    let header = BssrdfHeader {
        model: MODEL,
        coding: Coding::Exact,
        addressing: Addressing::Repeat,
        width: side,
        height: side,
        window_radius: radius,
        samples,
        base_materials: 1,
        pitch_mm,
        r_max_mm,
        eta,
    };
    let mut one = Mixture::default();
    one.ratios[0] = 1.0;
    let pixels = vec![one; (side * side) as usize];
    let mut sections = vec![profiles(values, false)];
    sections.extend(mixtures(&header, &pixels));
    Ok(write_file(&header, &sections))
}

/// Mean of R_d in mm⁻² over a square pixel whose middle is `r_mm` away along an axis.
fn pixel_mean(radial: &Radial, r_mm: f64, pitch_mm: f64) -> f64 {
    let half = 0.5 * pitch_mm;
    let [inner, outer] = [r_mm - half, r_mm + half];
    // A quarter's integral is odd in x.
    let inner = radial.corner(inner.abs(), half).copysign(inner);
    2.0 * (radial.corner(outer, half) - inner) / (pitch_mm * pitch_mm)
}
