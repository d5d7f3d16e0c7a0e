//! Triangle meshes: checked once, made finer, with tangents and charts; and shapes that need no file.

mod bounds;
mod charts;
mod shapes;
mod subdivide;
mod tangents;
mod triangles;

pub use bounds::BoundingSphere;
pub use shapes::{bowl, drapery, knot, plate, relief, sphere, torus};
pub use triangles::Mesh;
