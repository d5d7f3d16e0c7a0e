//! The ways from a profile of one channel to a sum of separable terms.

mod gaussians;
mod guided;
mod svd;
mod two_gaussians;

pub(super) use gaussians::gaussians;
pub(super) use guided::guided;
pub(super) use svd::svd;
pub(super) use two_gaussians::{fit as fit_two_gaussians, terms as two_gaussians};

use super::grid::{Grid, Separable};
use super::profile::Radial;

/// A_p = a_p(x) a_p(y) / ‖R_d‖₁ (eq. S.6).
pub(super) fn pre_integrated(radial: &Radial, grid: &Grid) -> Separable {
    let root = radial.energy().sqrt();
    let a = grid.means(|x| radial.along_axis_to(x) / root);
    Separable { grid: grid.clone(), terms: vec![(1.0, a)] }
}
