//! A frame: what is seen is placed, its blocks are uploaded, and its passes are recorded into the host's encoder.

use subsurf_scene::BoundingSphere;
use subsurf_shaders::uniform;
use wgpu::{CommandEncoder, LoadOp, Operations, RenderPassColorAttachment, StoreOp};

use super::input::{Input, Object, Target};
use super::options::RuntimeOptions;
use super::prepare::{Frame, Placed};
use super::renderer::Renderer;
use crate::error::{Error, Result};
use crate::gpu::{BLOCK_STRIDE, Gpu, attachment};
use crate::technique::{Attachments, Group, Lap, Viewport, group_number};

/// What a frame shows besides its objects.
struct Seen {
    block: uniform::Scene,
    /// Sphere that holds all objects.
    bounds: BoundingSphere,
}

impl Renderer {
    /// Records a frame into the host's encoder. Nothing is submitted, waited for or allocated on the device; only other
    /// shadow maps of the host's than before are bound anew. What a driver has to say comes by the device's own error handler.
    /// Where no object is seen, the target is cleared or left alone.
    ///
    /// Lights' views hold all objects of the input, seen or not: what is far from the others makes them coarse.
    ///
    /// Blocks are uploaded by the queue, which is done before the commands of the next submission: a frame can be recorded once
    /// for each submission, another [`Frame`] beside it.
    ///
    /// # Errors
    /// [`Error::Usage`] if the frame was not prepared for a material or for as many shadows, if there are too many objects or
    /// lights, a shadow map is not what it has to be, an object lacks what its material needs, the light of a gather was never summed, or the target is smaller than the
    /// frame; [`Error::Mesh`] if a material is precomputed for another mesh; [`Error::Device`] if the device is lost.
    pub fn draw(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        frame: &mut Frame,
        input: &Input<'_>,
        target: &Target<'_>,
    ) -> Result<()> {
        self.record(gpu, encoder, frame, input, target, &mut |_, _| {})
    }

    /// Sums the light of the reference, [`crate::Technique::Gather`], anew where lights have changed, in submissions of its
    /// own: what takes seconds is not for a frame. Other techniques have nothing to do here.
    ///
    /// # Errors
    /// As [`Renderer::draw`], and [`Error::Device`] if the device fails.
    pub fn gather(&self, gpu: &Gpu, frame: &mut Frame, input: &Input<'_>) -> Result<()> {
        let Some(seen) = frame.place(gpu, input, &self.options)? else {
            return Ok(());
        };
        let Frame { plan, common, slots, placed, .. } = frame;
        for (number, slot) in slots.iter_mut().enumerate() {
            if let Some(bounds) = slot.bounds {
                let group = Group::new(input, placed, number, bounds, &seen.block, seen.bounds.radius_mm, plan);
                slot.bindings.compute(gpu, &group, &common.object)?;
            }
        }
        Ok(())
    }

    /// Records all passes of a frame; `lap` is called after each.
    pub(super) fn record(
        &self,
        gpu: &Gpu,
        encoder: &mut CommandEncoder,
        frame: &mut Frame,
        input: &Input<'_>,
        target: &Target<'_>,
        lap: Lap<'_>,
    ) -> Result<()> {
        expect_room(target, frame.plan.size)?;
        let Some(seen) = frame.place(gpu, input, &self.options)? else {
            clear(encoder, target);
            return Ok(());
        };
        let Frame { plan, common, lights, slots, placed, .. } = frame;
        // What the camera does not see casts shadows all the same.
        let draws = || placed.iter().zip(input.objects).map(|(placed, object)| (object.mesh, placed.offset));
        let mut visible = slots.iter().filter(|slot| slot.bounds.is_some());
        if let Some(reason) = visible.find_map(|slot| slot.bindings.is_waiting()) {
            return Err(Error::Usage(reason.to_owned()));
        }
        let shadows = seen.block.drawn_shadows();
        lights.record(encoder, self.tsm.of(plan), shadows.count(), &common.object, draws);
        lap(self.tsm.of(plan).name(), encoder);

        // Materials with maps of their own come one after the other, each with its share of the picture.
        let last = slots.iter().rposition(|slot| slot.bounds.is_some());
        let mut is_first = true;
        for (number, slot) in slots.iter_mut().enumerate() {
            let Some(bounds) = slot.bounds else {
                continue;
            };
            let mut group = Group::new(input, placed, number, bounds, &seen.block, seen.bounds.radius_mm, plan);
            group.origin = target.origin;
            slot.bindings.update(gpu, &group);
            slot.bindings.record(encoder, &group, common.shared(), lap);
            let is_last = Some(number) == last;
            let attachments = Attachments {
                colours: &[Some(RenderPassColorAttachment {
                    resolve_target: if is_last { target.resolve } else { None },
                    ..attachment(target.colour, if is_first { target.load } else { LoadOp::Load })
                })],
                depth: target.depth,
                depth_ops: Operations {
                    load: if is_first { target.depth_ops.load } else { LoadOp::Load },
                    store: if is_last { target.depth_ops.store } else { StoreOp::Store },
                },
                viewport: Some(Viewport::at(target.origin, plan.size)),
            };
            let (pass, material) = slot.bindings.shade();
            pass.record(encoder, &attachments, [&slot.scene, material], common.shared(), group.draws());
            lap(pass.name(), encoder);
            is_first = false;
        }
        Ok(())
    }
}

impl Frame {
    /// Finds the materials and the blocks of all objects, and uploads the blocks; `None` if nothing is seen.
    fn place(&mut self, gpu: &Gpu, input: &Input<'_>, options: &RuntimeOptions) -> Result<Option<Seen>> {
        let room = self.common.objects.size() / u64::from(BLOCK_STRIDE);
        if input.objects.len() as u64 > room {
            return Err(Error::Usage(format!("{} objects; the renderer has room for {room}", input.objects.len())));
        }
        self.placed.clear();
        for slot in &mut self.slots {
            slot.bounds = None;
        }
        let (shadows, have) = (input.drawn_shadows(options)?, self.plan.lights);
        if shadows > have {
            let reason =
                format!("shadows of {shadows} lights; the frame was prepared for {have}: prepare it for all of them");
            return Err(Error::Usage(reason));
        }
        let mut all: Option<BoundingSphere> = None;
        for (object, number) in input.objects.iter().zip(0..) {
            object.expect_rigid()?;
            let bounds = object.bounds();
            let with_this = |known: &Option<BoundingSphere>| known.map_or(bounds, |known| known.union(&bounds));
            all = Some(with_this(&all));
            let unknown = || Error::Usage("a material that the frame was not prepared for".to_owned());
            let slot = self.slots.iter().position(|slot| slot.material.is(object.material)).ok_or_else(unknown)?;
            if object.material.is_of_one_object() {
                expect_one(object, self.placed.iter().any(|placed| placed.slot == slot))?;
            }
            let is_visible = input.view.sees(&bounds);
            if is_visible {
                let of_slot = &mut self.slots[slot].bounds;
                *of_slot = Some(with_this(of_slot));
            }
            self.placed.push(Placed { slot, offset: number * BLOCK_STRIDE, is_visible });
        }
        let is_seen = self.slots.iter().any(|slot| slot.bounds.is_some());
        let Some(bounds) = all.filter(|_| is_seen) else {
            return Ok(None);
        };
        let lighting = &input.lighting;
        let mut block = uniform::Scene::new(&input.view, input.exposure, lighting, &bounds, self.plan.light_texels);
        block.light_columns = self.plan.light_columns;
        input.project_maps(&mut block);
        self.common.host_shadows.show(gpu, input.shadow_maps)?;
        self.lights.update(gpu, block.drawn_shadows());
        gpu.write(&self.common.scene, bytemuck::bytes_of(&block))?;
        self.common.show(gpu, lighting.environment);

        self.blocks.clear();
        for (object, placed) in input.objects.iter().zip(&self.placed) {
            let group = self.slots[placed.slot].bounds.unwrap_or(bounds);
            let placement = object.material.placement(object.mesh, object.mapping)?;
            let block = uniform::Object {
                depth_offset_mm: (bounds.centre_mm - group.centre_mm).dot(input.view.forward()),
                group: group_number(placed.slot),
                ..uniform::Object::new(&placement, &object.world_from_mesh, object.roughness)
            };
            self.blocks.extend_from_slice(bytemuck::bytes_of(&block));
            self.blocks.resize(placed.offset as usize + BLOCK_STRIDE as usize, 0);
        }
        gpu.queue.write_buffer(&self.common.objects, 0, &self.blocks);
        Ok(Some(Seen { block, bounds }))
    }
}

/// Refuses what is not drawn where light is summed for the vertices of a mesh: they are those of one object in its own size.
fn expect_one(object: &Object<'_>, has_another: bool) -> Result<()> {
    if has_another {
        return Err(Error::Usage(
            "a material for the gather, or of a transfer, is that of one object: load it once for each".to_owned(),
        ));
    }
    if (object.world_from_mesh.x_axis.truncate().length() - 1.0).abs() > 1e-3 {
        return Err(Error::Usage(
            "the gather and transfers draw meshes in their own size: no scale in a transform".to_owned(),
        ));
    }
    Ok(())
}

/// Refuses a target that has no room for a picture of `size` from its origin on.
fn expect_room(target: &Target<'_>, size: [u32; 2]) -> Result<()> {
    let texture = target.colour.texture();
    let have = [texture.width(), texture.height()];
    let is_beyond = |k: usize| u64::from(target.origin[k]) + u64::from(size[k]) > u64::from(have[k]);
    if is_beyond(0) || is_beyond(1) {
        let origin = target.origin;
        return Err(Error::Usage(format!("a frame of {size:?} pixels from {origin:?} on, in a target of {have:?}")));
    }
    Ok(())
}

/// Clears what a host wants cleared.
fn clear(encoder: &mut CommandEncoder, target: &Target<'_>) {
    let is_kept = matches!((target.load, target.depth_ops.load), (LoadOp::Load, LoadOp::Load));
    if is_kept && target.resolve.is_none() {
        return;
    }
    let colour = RenderPassColorAttachment { resolve_target: target.resolve, ..attachment(target.colour, target.load) };
    let depth = wgpu::RenderPassDepthStencilAttachment {
        view: target.depth,
        depth_ops: Some(target.depth_ops),
        stencil_ops: None,
    };
    drop(encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("clear"),
        color_attachments: &[Some(colour)],
        depth_stencil_attachment: Some(depth),
        ..Default::default()
    }));
}
