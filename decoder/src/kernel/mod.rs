//! Separable kernels: the diffusion profile of a homogeneous material, and the products of 1-D kernels that stand for it
//! (`FORMAT.md`, section 6).

mod evaluate;
pub mod layout;
mod reader;

pub use layout::{KernelHeader, KernelMethod};
pub use reader::{Kernel, TwoGaussians};
