//! Factors of texels and of directions: a sum over components of what a texel has of each and what each looks like.
//!
//! Texels are sums of codewords, one from each stage of a residual vector quantiser (Juang and Gray 1982). Tables of
//! components over the grid are a Tucker decomposition (Tucker 1966), axes of views and of lights and a sparse core
//! between them, entropy-coded. [`Factored::expand`] undoes what makes files small; then every texel is at hand.

pub mod coder;
mod evaluate;
mod expand;
pub mod layout;
pub mod model;
mod reader;

pub use evaluate::Expanded;
pub use expand::Buffers;
pub use reader::Factored;
