//! What a frame shows, and where it is drawn to: all of it the host's.

use glam::{Mat4, Vec3};
use subsurf_scene::{Lighting, MAX_LIGHTS, Mapping, Scene, Shadow, View};
use subsurf_shaders::uniform;
use wgpu::{Color, LoadOp, Operations, TextureFormat, TextureUsages, TextureView};

use super::options::RuntimeOptions;
use crate::asset::{GpuMesh, Material};
use crate::error::{Error, Result};

/// Everything that a frame shows.
#[derive(Clone, Copy, Debug)]
pub struct Input<'a> {
    /// View of the camera.
    pub view: View,
    /// Factor on radiance, before tone mapping if there is any.
    pub exposure: f32,
    /// Light that falls on the objects, of at most [`MAX_LIGHTS`] sources.
    pub lighting: Lighting<'a>,
    /// Shadow maps of the host's own, which lights name by [`Shadow::Host`]; at most [`MAX_LIGHTS`]. Renderers take them by the
    /// option `host_shadow_maps`.
    pub shadow_maps: &'a [ShadowMap<'a>],
    /// Objects, in any order. Those of one material scatter light between each other.
    pub objects: &'a [Object<'a>],
}

/// Shadow map of the host's own: depth that a light sees. Nothing is in shadow beside it, and nothing beyond its far plane
/// unless something is seen before that.
///
/// It shadows our surfaces, and tells separable blurs the thickness of what the light shines through. Splats have no samples of
/// such a light: its light leaves where it enters. Gathers take visibilities from their points.
#[derive(Clone, Copy, Debug)]
pub struct ShadowMap<'a> {
    /// Depth, of any depth format (of a view that shows depth alone) or of `R32Float`, bound as a texture, one sample to a texel.
    /// Its first row is the upper one of clip space. A texel of the map's own is the least distance at which it tells surfaces
    /// apart; slopes take more.
    pub depth: &'a TextureView,
    /// Projection that the map was drawn with, from mm of the world to clip space: x and y from −1 to 1, depth from 0 to 1. Rays
    /// meet at the light, or are parallel to its direction.
    pub clip_from_world: Mat4,
    /// Whether depth falls from 1 near the light to 0 far away.
    pub is_reversed: bool,
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
            shadow_maps: &[],
            objects,
        }
    }

    /// Number of lights whose shadows are drawn.
    ///
    /// # Errors
    /// [`Error::Usage`] if there are too many lights or shadow maps, a light names a map that is not there, or a map cannot be
    /// read.
    pub(crate) fn drawn_shadows(&self, options: &RuntimeOptions) -> Result<u32> {
        let (lights, maps) = (self.lighting.lights, self.shadow_maps);
        if !maps.is_empty() && !options.host_shadow_maps {
            return Err(Error::Usage(
                "shadow maps of the host's; the renderer has no option host_shadow_maps".to_owned(),
            ));
        }
        for (what, count) in [("lights", lights.len()), ("shadow maps", maps.len())] {
            if count > MAX_LIGHTS {
                return Err(Error::Usage(format!("{count} {what}; a frame has at most {MAX_LIGHTS}")));
            }
        }
        for (number, map) in maps.iter().enumerate() {
            map.expect_readable(number)?;
        }
        let mut drawn = 0;
        for (number, light) in lights.iter().enumerate() {
            match light.shadow {
                Shadow::Host(map) if map >= maps.len() => {
                    let count = maps.len();
                    return Err(Error::Usage(format!(
                        "light {number} has shadow map {map} of {count}, counted from 0"
                    )));
                }
                Shadow::Drawn => drawn += 1,
                Shadow::Host(_) | Shadow::None => {}
            }
        }
        Ok(drawn)
    }

    /// Puts the projections of the host's maps into the blocks of their lights.
    pub(crate) fn project_maps(&self, block: &mut uniform::Scene) {
        for (to, light) in block.light.iter_mut().zip(self.lighting.lights) {
            if let Shadow::Host(number) = light.shadow {
                let map = &self.shadow_maps[number];
                to.clip_from_world = map.clip_from_world.to_cols_array_2d();
                to.shadow = if map.is_reversed { uniform::HOST_SHADOW_REVERSED } else { uniform::HOST_SHADOW };
            }
        }
    }
}

impl ShadowMap<'_> {
    /// Refuses what shaders cannot read as depth.
    fn expect_readable(&self, number: usize) -> Result<()> {
        let texture = self.depth.texture();
        let format = texture.format();
        let found = if !format.has_depth_aspect() && format != TextureFormat::R32Float {
            format!("{format:?}")
        } else if texture.sample_count() != 1 {
            format!("{} samples to a texel", texture.sample_count())
        } else if !texture.usage().contains(TextureUsages::TEXTURE_BINDING) {
            "no usage TEXTURE_BINDING".to_owned()
        } else {
            return Ok(());
        };
        let expected = "depth or R32Float, one sample to a texel, to be bound as a texture";
        Err(Error::Usage(format!("shadow map {number} has {found}; expected {expected}")))
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

    /// Lowest and highest corner of a box that holds the object, in the world.
    pub(crate) fn corners(&self) -> [glam::Vec3; 2] {
        let [low, high] = self.mesh.corners;
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let centre = self.world_from_mesh.transform_point3(centre);
        let axes = [0, 1, 2].map(|k| half[k] * self.world_from_mesh.col(k).truncate().abs());
        let reach = axes[0] + axes[1] + axes[2];
        [centre - reach, centre + reach]
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
