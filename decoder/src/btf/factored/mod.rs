//! BTFs as a Tucker decomposition (`FORMAT.md`, section 5): a sum over components of what a texel has of each and what
//! each looks like.
//!
//! Texels are sums of codewords, one from each stage of a residual vector quantiser (Juang and Gray 1982). Tables of
//! components over the grid are a Tucker decomposition (Tucker 1966), axes of views and of lights and a sparse core
//! between them, entropy-coded. [`FactoredBtf::expand`] undoes what makes files small; then every texel is at hand.

pub mod coder;
mod evaluate;
mod expand;
pub mod layout;
#[cfg(feature = "alloc")]
mod memory;
pub mod model;
mod reader;
#[cfg(feature = "push")]
mod rows;

pub use evaluate::ExpandedBtf;
pub use expand::ExpansionBuffers;
#[cfg(feature = "alloc")]
pub use memory::ExpansionMemory;
pub use reader::FactoredBtf;
#[cfg(feature = "push")]
pub(crate) use rows::FactoredRows;
