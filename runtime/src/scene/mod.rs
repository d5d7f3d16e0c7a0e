//! Meshes, and the points on them between which light scatters.

mod mesh;
mod shapes;
mod surface;

pub use mesh::Mesh;
pub use shapes::{sphere, torus};
pub use surface::{Mapping, Surface};
