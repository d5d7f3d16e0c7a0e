//! What a frame shows, and where it is drawn to: all of it the host's.

use glam::{Mat4, Vec3};
use subsurf_scene::{Lighting, Mapping, Scene, View};
use wgpu::{Color, LoadOp, Operations, TextureView};

use crate::asset::{GpuMesh, Material};
use crate::error::{Error, Result};

/// Everything that a frame shows.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// View of the camera.
    pub view: View,
    /// Factor on radiance, before tone mapping if there is any.
    pub exposure: f32,
    /// Light that falls on the objects.
    pub lighting: Lighting<'a>,
    /// Objects, in any order. Those of one material scatter light between each other.
    pub objects: &'a [Object<'a>],
}

/// Object: a mesh, what it is made of, and where it is.
#[derive(Clone, Copy, Debug)]
pub struct Object<'a> {
    /// Mesh.
    pub mesh: &'a GpuMesh,
    /// Material of the mesh.
    pub material: &'a Material,
    /// Rule by which the material lies on the mesh.
    pub mapping: Mapping,
    /// From mm of the mesh to mm of the world: a rotation, a uniform scale, a translation. The material keeps its own size.
    pub world_from_mesh: Mat4,
    /// GGX roughness of the smooth dielectric coat over the material, 0 to 1.
    pub roughness: f32,
}

/// Views to draw to, of the formats and the number of samples that were agreed on.
#[derive(Clone, Copy, Debug)]
pub struct Target<'a> {
    /// Colour.
    pub colour: &'a TextureView,
    /// Colour that pixels have before: what is there already, or one for all.
    pub load: LoadOp<Color>,
    /// Where the mean of the samples of a pixel goes, if there are several.
    pub resolve: Option<&'a TextureView>,
    /// Depth, which is compared and written.
    pub depth: &'a TextureView,
    /// Depth that pixels have before, and whether anyone wants it afterwards.
    pub depth_ops: Operations<f32>,
    /// Pixel of the target where the picture begins, from the left and from the top.
    pub origin: [u32; 2],
}

impl<'a> Input<'a> {
    /// Input for a picture of `size` pixels, width and height, of some objects that a scene's camera looks at.
    #[must_use]
    pub fn new(scene: &'a Scene, objects: &'a [Object<'a>], size: [u32; 2]) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
        let aspect = size[0] as f32 / size[1] as f32;
        let bounds = objects.iter().map(Object::bounds).reduce(|all, bounds| all.union(&bounds));
        let bounds = bounds.unwrap_or(subsurf_scene::BoundingSphere { centre_mm: Vec3::ZERO, radius_mm: 1.0 });
        Self {
            view: View::new(&scene.camera, &bounds, aspect),
            exposure: scene.camera.exposure,
            lighting: scene.lighting(bounds.centre_mm),
            objects,
        }
    }
}

/// How far a transform may be from a rotation and a uniform scale.
const SKEW: f32 = 1e-3;

impl<'a> Object<'a> {
    /// Object that stays where its mesh is.
    #[must_use]
    pub fn new(mesh: &'a GpuMesh, material: &'a Material, mapping: Mapping, roughness: f32) -> Self {
        Self { mesh, material, mapping, world_from_mesh: Mat4::IDENTITY, roughness }
    }

    /// Sphere that holds the object, in the world.
    pub(crate) fn bounds(&self) -> subsurf_scene::BoundingSphere {
        self.mesh.bounds.transformed(&self.world_from_mesh)
    }

    /// Refuses a transform that changes angles.
    pub(crate) fn expect_rigid(&self) -> Result<()> {
        let [x, y, z] = [0, 1, 2].map(|k| self.world_from_mesh.col(k).truncate());
        let length2 = x.length_squared();
        let skews = [y.length_squared() - length2, z.length_squared() - length2, x.dot(y), y.dot(z), z.dot(x)];
        let is_affine = self.world_from_mesh.row(3) == glam::Vec4::W;
        if is_affine && length2 > 0.0 && skews.iter().all(|skew| skew.abs() <= SKEW * length2) {
            return Ok(());
        }
        Err(Error::Usage("world_from_mesh is no rotation with a uniform scale and a translation".to_owned()))
    }
}
