//! LinSSS (Yatagawa, Yamaguchi and Morishima 2020, "LinSSS: linear decomposition of heterogeneous subsurface scattering for
//! real-time screen-space rendering", The Visual Computer 36): a rival that is drawn by blurs, too.
//!
//! Rd(x_i, x_o) pitch² ≈ ½ Σ_h (W_h(x_o) + W_h(x_i)) G(r; σ_h), with weights W ≥ 0 for every pixel and channel and standard
//! deviations σ for every channel, shared by all pixels. The model is linear in the weights: they are found by non-negative least
//! squares over all pairs of a capture (`weights`), beside which the exitance under uniform light counts, without which the
//! albedo is 10 dB worse. Standard deviations descend along with them (`widths`).

mod channel;
mod convolve;
mod file;
mod model;
mod pyramid;
mod sums;
#[cfg(test)]
mod tests;
mod weights;
mod widths;

pub use model::LinSss;

use subsurf_decoder::bssrdf::Addressing;

use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::math::parallel;
use crate::progress::Progress;
use channel::Channel;
use sums::RingSums;

/// Most Gaussians that the authors' program takes.
pub const MAX_GAUSSIANS: usize = 8;

/// Fits so many Gaussians to a capture.
///
/// # Errors
/// [`Error::Request`] for a number of Gaussians that is not 1 to [`MAX_GAUSSIANS`], a patch that goes on beyond its border, or a
/// capture in which a pair was not measured: sums over pairs are taken as convolutions.
pub fn fit(capture: &Capture, gaussians: usize, progress: &dyn Progress) -> Result<LinSss> {
    if !(1..=MAX_GAUSSIANS).contains(&gaussians) {
        return Err(Error::Request(format!("{gaussians} Gaussians; LinSSS has 1 to {MAX_GAUSSIANS}")));
    }
    if capture.addressing() != Addressing::Clamp {
        let (path, found) = (capture.path().display(), capture.addressing());
        return Err(Error::Request(format!(
            "{path}: the addressing is {found:?}; LinSSS is fitted to patches that end, Clamp"
        )));
    }
    let sums = RingSums::read(capture)?;
    progress.begin("fitting LinSSS", 3);
    let fitted: Vec<(Vec<f64>, Vec<Vec<f32>>)> = parallel::map(3, |c| {
        let channel = Channel::new(&sums, c);
        let sigmas = widths::descend(&channel, gaussians, progress);
        let weights = weights::solve(&channel, &sigmas, None, weights::ROUNDS, progress);
        progress.advance(1);
        (sigmas, weights)
    });
    Ok(LinSss::new(capture, &fitted))
}
