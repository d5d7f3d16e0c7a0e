//! Separable kernels of homogeneous diffusion profiles (Jimenez et al. 2015, *Separable subsurface scattering*).
//!
//! A [`Profile`] is simulated, measured, of a base material or an artist's; [`encode()`] makes a [`Kernel`] of it, which is drawn
//! by convolutions along two axes. Equations are those of the paper's supplement.

mod encode;
pub(crate) mod grid;
mod method;
mod model;
pub mod profile;
mod taps;
mod write;

pub use encode::{Encoded, Options, compare, encode};
pub use grid::Separable;
pub use model::{Kernel, Term};
pub use profile::Profile;
pub use subsurf_decoder::kernel::layout::{MAX_TERMS, TAPS};
pub use subsurf_decoder::kernel::{KernelMethod, TwoGaussians};
