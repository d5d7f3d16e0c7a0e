//! Profiles of an artist's two Gaussians.

use subsurf_decoder::kernel::TwoGaussians;

use super::Radial;
use crate::error::{Error, Result};

/// Standard deviations that rings reach: 2·10⁻¹¹ of the light is beyond.
const REACH: f64 = 7.0;
/// Rings.
const RINGS: u32 = 1_024;
/// Smallest and largest variance in mm².
const VARIANCES: [f32; 2] = [1e-8, 1e8];

/// Whether shares and variances are such.
///
/// # Errors
///
/// [`Error::Request`] for shares outside 0 to 1, variances that are none, and a near Gaussian that is wider than the far one.
pub(in crate::kernel) fn check(two: &TwoGaussians) -> Result<()> {
    if let Some(wrong) = two.weight.iter().find(|w| !(0.0..=1.0).contains(*w)) {
        return Err(Error::Request(format!("a share of {wrong} for the near Gaussian; expected 0 to 1")));
    }
    for (near, far) in two.tau_near.iter().zip(&two.tau_far) {
        let [least, most] = VARIANCES;
        if let Some(wrong) = [near, far].into_iter().find(|tau| !(least..=most).contains(*tau)) {
            return Err(Error::Request(format!("a variance of {wrong} mm²; expected {least} to {most}")));
        }
        if near > far {
            return Err(Error::Request(format!(
                "a near Gaussian of {near} mm² beside a far one of {far} mm²; expected the near one to be narrower"
            )));
        }
    }
    Ok(())
}

/// Profile w G(τ_near) + (1 − w) G(τ_far) in the plane, of channel `c`: along an axis it is the artist's (section E).
pub(super) fn radial(two: &TwoGaussians, reflectance: [f32; 3], c: usize) -> Radial {
    let [w, near, far, total] = [two.weight[c], two.tau_near[c], two.tau_far[c], reflectance[c]].map(f64::from);
    // T(r) of both.
    let tail = |r: f64| {
        let gaussian = |tau: f64| (-r * r / (2.0 * tau)).exp();
        total * (w * gaussian(near) + (1.0 - w) * gaussian(far))
    };
    Radial::of_tail(REACH * far.sqrt(), RINGS, tail)
}
