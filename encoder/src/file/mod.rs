//! `.subsurf` files as bytes and on disk.

pub(crate) mod container;
pub(crate) mod output;
pub(crate) mod reread;
