//! Flat patches: irradiance in, exitance and a picture out.

mod gather;
mod homogeneous;
mod separable;
mod surface;

pub use gather::PatchRenderer;
pub use homogeneous::{HomogeneousPatch, HomogeneousRenderer};
pub(crate) use separable::PatchCascade;
pub use separable::{SeparablePatch, SeparableRenderer};
pub use surface::{Exitance, PatchLight, Region};
