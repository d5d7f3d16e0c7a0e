//! What techniques have in common: pipelines that are compiled once, and what is bound to them for one frame.

use std::fmt::Debug;
use std::sync::Arc;

use subsurf_scene::{Placement, Scene};
use subsurf_shaders::uniform;
use wgpu::{BindGroup, CommandEncoder};

use super::common::{Common, Lap};
use super::drawable::Drawable;
use super::mesh_pass::MeshPass;
use super::tsm::TranslucentShadowMaps;
use crate::asset::GpuMesh;
use crate::error::{Error, Result};
use crate::frame::plan::Plan;
use crate::gpu::Gpu;

/// Pipelines of one technique; made at load, never in a frame.
pub(crate) trait Pipelines: Debug {
    /// Bytes on the device of shadow maps and of all maps, for frames of a plan.
    fn bytes(&self, plan: &Plan, _placement: &Placement) -> u64 {
        plan.light_bytes(1)
    }

    /// Mipmap levels of the shadow maps, at least 1.
    fn light_levels(&self, _plan: &Plan, _placement: &Placement) -> u32 {
        1
    }

    /// Pixels of the picture to a side of a texel of the maps, at least 1, when a mm at the middle of the mesh covers
    /// `pixels_per_mm`.
    fn divisor(&self, _drawable: &Drawable<'_>, _light_texels: u32, _pixels_per_mm: f32) -> u32 {
        1
    }

    /// Pipeline of the picture; bind group 0 is the scene's, 1 the technique's.
    fn shade(&self) -> &MeshPass;

    /// Makes room for frames of a plan and binds all of it.
    ///
    /// # Errors
    /// [`Error::Device`] if the drawable is for another technique.
    fn bind(
        self: Arc<Self>,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        common: &Common,
        lights: &TranslucentShadowMaps,
        plan: &Plan,
    ) -> Result<Box<dyn Bindings>>;
}

/// What is bound to the pipelines of one technique for frames of one size.
pub(crate) trait Bindings: Debug {
    /// Uploads what has changed since the last frame.
    ///
    /// # Errors
    /// [`Error::Device`] if the drawable is not the one that was bound.
    fn update(
        &mut self,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        scene: &Scene,
        block: &uniform::Scene,
        plan: &Plan,
    ) -> Result<()>;

    /// Records all passes between shadow maps and the picture, of the first `lights` lights; `lap` is called after each.
    fn record(
        &self,
        encoder: CommandEncoder,
        _mesh: &GpuMesh,
        _lights: usize,
        _plan: &Plan,
        _lap: Lap<'_>,
    ) -> CommandEncoder {
        encoder
    }

    /// Bind group 1 of [`Pipelines::shade`].
    fn shade(&self) -> &BindGroup;
}

/// The error for a drawable of another technique than the pipelines.
pub(crate) fn wrong_drawable() -> Error {
    Error::Device("the drawable is for another technique than the renderer".to_owned())
}
