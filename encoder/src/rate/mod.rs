//! The smallest file of a quality, or the best of a size.

pub mod bssrdf;
pub mod btf;
