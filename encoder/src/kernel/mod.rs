//! Separable kernels of homogeneous diffusion profiles (Jimenez et al. 2015, *Separable subsurface scattering*).

mod model;

pub use model::{Kernel, Term, TwoGaussians};
pub use subsurf_decoder::kernel::KernelMethod;
