//! Flat patches: irradiance in, exitance and a picture out.

mod gather;
mod homogeneous;
#[cfg(feature = "reference")]
mod kernel;
mod separable;
mod surface;

pub use gather::PatchRenderer;
pub use homogeneous::{HomogeneousPatch, HomogeneousRenderer};
#[cfg(feature = "reference")]
pub use kernel::KernelScreen;
pub(crate) use separable::PatchCascade;
pub use separable::{SeparablePatch, SeparableRenderer};
pub use surface::{Exitance, PatchLight, Region};
