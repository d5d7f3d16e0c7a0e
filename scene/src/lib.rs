//! What is drawn, without a GPU: meshes and where materials lie on them, lights, environment and camera.
//!
//! Lengths are in mm, y is up, colours are linear Rec. 709.

mod camera;
mod error;
mod light;
mod mapping;
mod mesh;
mod placement;
mod points;
mod read;
mod scene;
mod view;

pub use camera::Camera;
pub use error::{Error, Result};
pub use light::{Environment, Light, LightShape, MAX_LIGHTS, REFLECTION_LEVELS, REFLECTION_SIZE, visibility};
pub use mapping::{Mapping, place_in_box};
pub use mesh::{BoundingSphere, Mesh, bowl, drapery, knot, relief, sphere, torus};
pub use placement::Placement;
pub use points::{PointGrid, SurfacePoints};
pub use read::{LoadedMesh, MESH_EXTENSIONS, SHAPES, UpAxis, load_mesh};
pub use scene::{Lighting, Scene};
pub use view::View;
