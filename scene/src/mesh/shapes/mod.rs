//! Meshes that need no file.

mod bowl;
mod drapery;
mod lattice;
mod plate;
mod sphere;
mod tube;

#[cfg(test)]
mod tests;

pub use bowl::bowl;
pub use drapery::drapery;
pub use plate::plate;
pub use sphere::{relief, sphere};
pub use tube::{knot, torus};
