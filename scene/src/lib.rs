//! What is drawn, without a GPU: meshes and where materials lie on them, lights, environment and camera.
//!
//! Lengths are in mm, y is up, colours are linear Rec. 709.

mod error;
mod light;
mod mapping;
mod mesh;
mod placement;
mod points;
mod read;
mod scene;

pub use error::{Error, Result};
pub use light::{Environment, Light, LightShape, MAX_LIGHTS, REFLECTION_LEVELS, REFLECTION_SIZE, visibility};
pub use mapping::{Mapping, place_in_box};
pub use mesh::{Mesh, bowl, drapery, knot, relief, sphere, torus};
pub use placement::Outline;
pub use points::{PointGrid, SurfacePoints};
pub use read::{SHAPES, Up, load};
pub use scene::{Scene, View};
