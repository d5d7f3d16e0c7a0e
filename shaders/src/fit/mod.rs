//! Fit of a [`SeparableBasis`] to a material, and the mean profile that homogeneous drawing takes.

mod basis;
mod choose;
mod gaussians;
mod mean;
mod radial;

pub use mean::{mean_kernel, softening_gain};
pub use radial::mean_profile;

#[cfg(doc)]
use crate::separable::SeparableBasis;
