//! Separable kernels of homogeneous diffusion profiles (Jimenez et al. 2015, *Separable subsurface scattering*).

mod model;
mod write;

pub use model::{Kernel, Term};
pub use subsurf_decoder::kernel::{KernelMethod, TwoGaussians};
