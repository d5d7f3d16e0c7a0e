//! What is drawn, without a GPU: meshes and where materials lie on them, lights, environment and camera.
//!
//! Lengths are in mm, y is up, colours are linear Rec. 709.
//!
//! The feature `bake` adds what is computed of a mesh ahead of time, on all cores: which vertices a light reaches, and how much
//! of the light from all around leaves at each.

mod camera;
mod error;
mod light;
mod mapping;
mod mean_profile;
mod mesh;
mod placement;
mod points;
mod read;
mod scene;
mod view;

pub use camera::Camera;
pub use error::{Error, Result};
pub use light::{
    AmbientTransfer, Environment, Light, LightShape, MAX_LIGHTS, REFLECTION_LEVELS, REFLECTION_SIZE, Shadow,
};
#[cfg(feature = "bake")]
pub use light::{Occluder, visibility};
pub use mapping::{BoxPlaces, BoxSides, Mapping};
pub use mean_profile::MeanProfile;
pub use mesh::{BoundingSphere, Mesh, bowl, drapery, knot, plate, relief, sphere, torus};
pub use placement::Placement;
pub use points::{PointGrid, SurfacePoints};
pub use read::{LoadedMesh, MESH_EXTENSIONS, SHAPES, UpAxis, load_mesh};
pub use scene::{Lighting, Scene};
pub use view::View;
