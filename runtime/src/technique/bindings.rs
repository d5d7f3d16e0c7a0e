//! What techniques have in common: the passes of the objects of one material in a frame.

use std::fmt::Debug;

use glam::Vec3;
use subsurf_scene::BoundingSphere;
use subsurf_shaders::uniform::{self, ScreenDomain, Upsampling};
use wgpu::{BindGroup, CommandEncoder};

use super::area::MapArea;
use super::mesh_pass::{Draw, MeshPass, SharedGroups};
use crate::error::Result;
use crate::frame::{Input, Placed, Plan};
use crate::gpu::Gpu;

/// Passes of one material in a frame, with everything that is bound to them.
pub(crate) trait Bindings: Debug + Send + Sync {
    /// Uploads what has changed since the last frame.
    fn update(&mut self, _gpu: &Gpu, _group: &Group<'_>) {}

    /// Computes in submissions of its own what takes too long for a frame, unless it is known already.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device fails.
    fn compute(&mut self, _gpu: &Gpu, _group: &Group<'_>, _objects: &BindGroup) -> Result<()> {
        Ok(())
    }

    /// What has to be done before a frame can be drawn, if anything.
    fn is_waiting(&self) -> Option<&'static str> {
        None
    }

    /// Records all passes between shadow maps and the picture; `lap` is called after each.
    fn record(&self, _encoder: &mut CommandEncoder, _group: &Group<'_>, _shared: SharedGroups<'_>, _lap: Lap<'_>) {}

    /// Pipeline of the picture, and its bind group 1.
    fn shade(&self) -> (&MeshPass, &BindGroup);
}

/// Callback after each pass: is told its name, and may exchange the encoder for another one.
pub(crate) type Lap<'a> = &'a mut dyn FnMut(&'static str, &mut CommandEncoder);

/// Objects of one material in a frame.
pub(crate) struct Group<'a> {
    pub(crate) input: &'a Input<'a>,
    /// Where the objects of the input are; in the same order.
    pub(crate) placed: &'a [Placed],
    /// Number of the material in the frame, from 0.
    pub(crate) slot: usize,
    /// Sphere that holds the visible objects of the group.
    pub(crate) bounds: BoundingSphere,
    pub(crate) block: &'a uniform::Scene,
    /// Radius of the sphere that holds all objects, in mm.
    pub(crate) radius_mm: f32,
    pub(crate) plan: &'a Plan,
    /// Pixel of the target where the picture begins.
    pub(crate) origin: [u32; 2],
}

impl<'a> Group<'a> {
    /// Objects of material number `slot` that lie within `bounds`, of a scene within `radius_mm`.
    pub(crate) fn new(
        input: &'a Input<'a>,
        placed: &'a [Placed],
        slot: usize,
        bounds: BoundingSphere,
        block: &'a uniform::Scene,
        radius_mm: f32,
        plan: &'a Plan,
    ) -> Self {
        Self { input, placed, slot, bounds, block, radius_mm, plan, origin: [0; 2] }
    }

    /// Meshes of the visible objects of the group.
    pub(crate) fn draws(&self) -> impl Iterator<Item = Draw<'a>> + use<'a> {
        let (slot, objects) = (self.slot, self.input.objects.iter());
        let drawn = self.placed.iter().zip(objects).filter(move |(placed, _)| placed.is_visible && placed.slot == slot);
        drawn.map(|(placed, object)| (object.mesh, placed.offset))
    }

    /// Lowest and highest corner of a box that holds all objects of the group, seen or not, in mm.
    pub(crate) fn extent(&self) -> [Vec3; 2] {
        let objects = self.placed.iter().zip(self.input.objects);
        let of_group = objects.filter(|(placed, _)| placed.slot == self.slot);
        of_group.fold([Vec3::INFINITY, Vec3::NEG_INFINITY], |[low, high], (_, object)| {
            let [lowest, highest] = object.corners();
            [low.min(lowest), high.max(highest)]
        })
    }

    /// Number of the group in the blocks of shaders, from 1.
    pub(crate) fn number(&self) -> f32 {
        group_number(self.slot)
    }

    /// Distance of the middle of the group along the axis of the camera in mm; 1 in parallel projection.
    pub(crate) fn middle_mm(&self) -> f32 {
        if self.input.view.is_parallel() {
            return 1.0;
        }
        (self.bounds.centre_mm - self.input.view.eye_mm()).dot(self.input.view.forward())
    }

    /// Block of how large things are on maps over an area, for a material whose pixels are `pitch_mm` apart.
    pub(crate) fn screen(&self, area: &MapArea, pitch_mm: f32, is_jittered: bool) -> ScreenDomain {
        let view = &self.input.view;
        ScreenDomain {
            size: area.size,
            focal_texels: area.texels_per_tangent(view).map(|texels| texels * pitch_mm),
            middle_mm: self.middle_mm(),
            pitch_mm,
            perspective: if view.is_parallel() { 0.0 } else { 1.0 },
            is_jittered: u32::from(is_jittered),
        }
    }

    /// Block of how pixels of the target lie on maps over an area.
    pub(crate) fn upsampling(&self, area: &MapArea) -> Upsampling {
        area.upsampling(&self.input.view, self.plan.size, self.origin, self.middle_mm())
    }
}

/// Number of a group in the blocks of shaders.
pub(crate) fn group_number(slot: usize) -> f32 {
    #[allow(clippy::cast_precision_loss, reason = "half floats hold 2,048 of them")]
    let number = slot as f32 + 1.0;
    number
}
