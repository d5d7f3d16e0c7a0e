//! Factors of texels and of directions, small enough for a file: `subsurf_decoder::btf::factored` reads them.
//!
//! The components of a truncated SVD are fitted to the grid (`space`), their tables become axes and a sparse core
//! (`angles`), and texels become sums of codewords (`texels`), chosen for the tables as they will be decoded.

mod angles;
mod budget;
mod coder;
mod encode;
mod sizes;
mod space;
mod streams;
mod texels;
mod write;

pub use angles::CoreSize;
pub use encode::{Options, Prepared};
pub use sizes::Sizes;
pub(crate) use streams::{codewords, core};
pub use texels::StageSize;

#[cfg(test)]
#[allow(clippy::cast_possible_truncation, reason = "small numbers")]
mod tests;
