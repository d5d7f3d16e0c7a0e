//! Kernels: homogeneous diffusion profiles as sums of few separable ones (`FORMAT.md`, section 6).

mod evaluate;
pub mod layout;
mod method;
pub(crate) mod reader;
#[cfg(feature = "push")]
mod rows;

pub use layout::KernelHeader;
pub use method::KernelMethod;
pub use reader::{Kernel, TwoGaussians};
#[cfg(feature = "push")]
pub(crate) use rows::KernelRows;
