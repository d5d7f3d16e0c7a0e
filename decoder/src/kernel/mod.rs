//! Kernels: homogeneous diffusion profiles as sums of few separable ones.

mod method;

pub use method::KernelMethod;
