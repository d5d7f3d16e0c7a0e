//! Block of an object: where it is, and how its material lies on it.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3};
use subsurf_scene::{BoundingSphere, Mapping, Placement, Scene as SceneOfOne, View};

use super::scene::Scene;
use crate::cpu::diffuse_transmittance;

/// `Object` of `object.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Object {
    /// From mm of the mesh to mm of the world: a rotation, a uniform scale, a translation; column-major.
    pub world_from_mesh: [[f32; 4]; 4],
    /// From the world to the axes of the mesh, without the scale; column-major.
    pub place_from_world: [[f32; 4]; 4],
    /// Copies of the material to the unit square of texture coordinates.
    pub uv_scale: [f32; 2],
    /// Box mapping: copies of the patch to a mm, in x and y.
    pub patches_per_mm: [f32; 2],
    /// 0 texture coordinates, 1 box mapping.
    pub is_boxed: u32,
    /// Refractive index of the material against air.
    pub eta: f32,
    /// 1 − F_dr from outside: share of light from all around that enters.
    pub sky_transmittance: f32,
    /// GGX roughness of the coat, 0 to 1.
    pub roughness: f32,
    /// Added to depth from the middle of the scene, in mm: depth 0 is in the middle of the group.
    pub depth_offset_mm: f32,
    /// Number of the group that exchanges light with the object, from 1 on.
    pub group: f32,
    /// 1, or −1 where the transform is a mirror.
    pub handedness: f32,
    #[doc(hidden)]
    pub pad: u32,
}

impl Object {
    /// Block of a mesh that a transform puts into the world, alone in group 1.
    #[must_use]
    pub fn new(placement: &Placement, world_from_mesh: &Mat4, roughness: f32) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "patches are a few thousand pixels wide")]
        let [width, height] = placement.size.map(|side| side as f32);
        let pitch_mm = placement.pitch_mm;
        let scale = world_from_mesh.x_axis.truncate().length().max(f32::MIN_POSITIVE);
        let rigid = *world_from_mesh * Mat4::from_scale(Vec3::splat(1.0 / scale));
        Self {
            world_from_mesh: world_from_mesh.to_cols_array_2d(),
            place_from_world: rigid.inverse().to_cols_array_2d(),
            uv_scale: match placement.mapping {
                Mapping::Uv(copies) => copies,
                Mapping::Box => [0.0; 2],
            },
            patches_per_mm: [1.0 / (pitch_mm * width), 1.0 / (pitch_mm * height)],
            is_boxed: u32::from(placement.mapping == Mapping::Box),
            eta: placement.eta,
            sky_transmittance: diffuse_transmittance(placement.eta),
            roughness: roughness.clamp(0.0, 1.0),
            depth_offset_mm: 0.0,
            group: 1.0,
            handedness: world_from_mesh.determinant().signum(),
            pad: 0,
        }
    }
}

/// Blocks of a picture of one object, for the passes on the CPU.
#[derive(Clone, Copy, Debug)]
pub struct Blocks {
    /// Lights, environment and camera.
    pub scene: Scene,
    /// The object, which stays where its mesh is.
    pub object: Object,
}

impl Blocks {
    /// Blocks for a picture of `size` pixels, when lights have views of `light_texels` to a side.
    #[must_use]
    pub fn new(scene: &SceneOfOne, placement: &Placement, size: [u32; 2], light_texels: u32) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
        let aspect = size[0] as f32 / size[1] as f32;
        let bounds: BoundingSphere = placement.bounds;
        let view = View::new(&scene.camera, &bounds, aspect);
        let lighting = scene.lighting(bounds.centre_mm);
        Self {
            scene: Scene::new(&view, scene.camera.exposure, &lighting, &bounds, light_texels),
            object: Object::new(placement, &Mat4::IDENTITY, scene.roughness),
        }
    }
}
