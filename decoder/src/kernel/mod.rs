//! Kernels: homogeneous diffusion profiles as sums of few separable ones (`FORMAT.md`, section 6).

mod evaluate;
pub mod layout;
mod method;
pub(crate) mod reader;
mod rows;

pub use layout::KernelHeader;
pub use method::KernelMethod;
pub use reader::{Kernel, TwoGaussians};
pub(crate) use rows::KernelRows;
