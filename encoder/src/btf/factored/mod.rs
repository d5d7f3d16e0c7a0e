//! Factors of texels and of directions, small enough for a file: `subsurf_decoder::btf::factored` reads them.
//!
//! The survey's components are fitted to the grid (`space`), their tables become axes and a sparse core
//! (`angles`), and texels become sums of codewords (`texels`), chosen for the tables as they will be decoded.

mod angles;
mod coder;
mod encode;
mod sizes;
mod space;
mod texels;
mod write;

pub use angles::CoreSize;
pub use encode::{Options, Prepared};
pub use sizes::Sizes;
pub use texels::StageSize;
pub(super) use texels::{means, nearest};

#[cfg(test)]
#[allow(clippy::cast_possible_truncation, reason = "small numbers")]
mod tests;
