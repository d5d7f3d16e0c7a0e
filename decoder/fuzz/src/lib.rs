//! What the fuzz targets share: mutation of files by their sections, arguments of calls, and what holds for any error.
//!
//! Inputs are `.subsurf` files, so that every vector is a seed and every input can be read by any reader. Bytes behind the file, which
//! readers ignore, are the arguments of the calls that a target makes.

mod arguments;
mod errors;
mod mutate;
mod parts;

pub use arguments::Arguments;
pub use errors::check_error;
pub use mutate::mutate;
