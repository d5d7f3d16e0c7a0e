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

pub use encode::{Encoded, MAX_TERMS, Options, TAPS, compare, encode};
pub use model::{Kernel, Term, TwoGaussians};
pub use profile::Profile;
pub use subsurf_decoder::kernel::KernelMethod;
