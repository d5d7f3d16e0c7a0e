//! `.subsurf` files as bytes and on disk, and texts of others.

pub(crate) mod container;
pub(crate) mod metadata;
pub(crate) mod output;
pub(crate) mod reread;
pub(crate) mod text;
