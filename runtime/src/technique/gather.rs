//! The gather, the reference: every vertex sums the light of all others within reach.

use std::sync::{Arc, PoisonError};

use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::ROW;
use subsurf_shaders::{MaterialLayout, uniform};
use wgpu::{BindGroup, BindingResource};

use super::bindings::{Bindings, Group};
use super::common::Common;
use super::mesh_pass::MeshPass;
use crate::asset::{GatherMaterial, LitBy, tiled_size};
use crate::error::Result;
use crate::frame::RuntimeOptions;
use crate::gpu::{FullscreenPass, Gpu, Rows, array_size};

/// Points within reach of a point, seldom more.
const NEIGHBOURS: u64 = 4_096;

/// Pipelines for materials of one layout.
#[derive(Debug)]
pub(crate) struct Passes {
    irradiance: FullscreenPass,
    gather: FullscreenPass,
    shade: MeshPass,
}

/// Bind groups of the gather.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    material: Arc<GatherMaterial>,
    irradiance: [BindGroup; 2],
    gather: [BindGroup; 2],
    shade: BindGroup,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, layout: MaterialLayout, options: &RuntimeOptions) -> Result<Self> {
        let targets = [gpu.target_texture_format()];
        let gather = table::SURFACE_GATHER.with(Choice::Material(layout));
        Ok(Self {
            irradiance: FullscreenPass::new(gpu, table::IRRADIANCE.only(), &targets)?,
            gather: FullscreenPass::new(gpu, gather, &targets)?,
            shade: MeshPass::picture(gpu, table::SHADE_VERTEX.only(), options)?,
        })
    }

    /// Binds a material and its points.
    pub(crate) fn bind(
        self: &Arc<Self>,
        gpu: &Gpu,
        material: &Arc<GatherMaterial>,
        common: &Common,
    ) -> Result<Box<dyn Bindings>> {
        let texture = BindingResource::TextureView;
        let GatherMaterial { planes, points } = &**material;
        let of_irradiance =
            [texture(&points.positions.view), texture(&points.normals.view), texture(&points.visibilities.view)];
        let of_points = [
            points.grid.as_entire_binding(),
            texture(&points.positions.view),
            texture(&points.cell_starts.view),
            texture(&points.pixels.view),
            texture(&points.irradiance.view),
        ];
        let of_shade = [texture(&points.exitance.view), texture(&points.visibilities.view)];
        Ok(Box::new(Bound {
            irradiance: [
                self.irradiance.bind(gpu, 0, &[common.scene.as_entire_binding()])?,
                self.irradiance.bind(gpu, 1, &of_irradiance)?,
            ],
            gather: [self.gather.bind(gpu, 0, &planes.resources())?, self.gather.bind(gpu, 1, &of_points)?],
            shade: self.shade.bind(gpu, 1, &of_shade)?,
            material: material.clone(),
            passes: self.clone(),
        }))
    }
}

impl Bindings for Bound {
    /// Light that leaves the mesh: irradiance at every point, then Σ Rd(x_i, x_o) E(x_i) dA over their neighbours, unless
    /// it is known already.
    fn compute(&mut self, gpu: &Gpu, group: &Group<'_>, objects: &BindGroup) -> Result<()> {
        let mut of_group = group.input.objects.iter().zip(group.placed).filter(|(_, placed)| placed.slot == group.slot);
        let Some((object, placed)) = of_group.next() else {
            return Ok(());
        };
        let points = &self.material.points;
        let lit_by = (lighting(group.block), object.world_from_mesh);
        let is_same = |(block, transform): &LitBy| {
            bytemuck::bytes_of(block) == bytemuck::bytes_of(&lit_by.0) && *transform == lit_by.1
        };
        // Unknown until all of it is summed.
        let mut known = points.lit_by.lock().unwrap_or_else(PoisonError::into_inner);
        if known.as_ref().is_some_and(is_same) {
            return Ok(());
        }
        *known = None;
        let [scene, of_points] = &self.irradiance;
        let object = Some((objects, placed.offset));
        let of_irradiance = Rows::all(array_size(points.count));
        self.passes.irradiance.draw_for(gpu, &points.irradiance.view, &[scene, of_points], object, of_irradiance)?;
        let [material, of_points] = &self.gather;
        for rows in Rows::bands(tiled_size(points.count), u64::from(ROW) * NEIGHBOURS) {
            self.passes.gather.draw(gpu, &points.exitance.view, &[material, of_points], rows)?;
        }
        *known = Some(lit_by);
        Ok(())
    }

    fn is_waiting(&self) -> Option<&'static str> {
        let known = self.material.points.lit_by.lock().unwrap_or_else(PoisonError::into_inner);
        known.is_none().then_some("the light of a gather was never summed: call Renderer::gather")
    }

    fn shade(&self) -> (&MeshPass, &BindGroup) {
        (&self.passes.shade, &self.shade)
    }
}

/// Block of a scene without what only the eye sees.
fn lighting(block: &uniform::Scene) -> uniform::Scene {
    let none = bytemuck::Zeroable::zeroed();
    let mut light = block.light;
    for source in &mut light {
        source.clip_from_world = [[0.0; 4]; 4];
        (source.middle_mm, source.texel_mm) = (0.0, 0.0);
        // Points know what reaches them.
        (source.shadow, source.map) = (0, 0);
        // The axis of a light that shines all around is that of its view.
        if source.cos_outer < -1.0 {
            source.axis = [0.0; 3];
        }
    }
    uniform::Scene { lights: block.lights, sky: block.sky, light, ..none }
}
