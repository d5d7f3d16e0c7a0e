//! The gather, the reference: every vertex sums the light of all others within reach.

use std::sync::Arc;

use subsurf_scene::Scene;
use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::ROW;
use subsurf_shaders::{MaterialLayout, uniform};
use wgpu::{BindGroup, BindingResource, TextureFormat};

use super::common::Common;
use super::drawable::Drawable;
use super::mesh_pass::MeshPass;
use super::pipelines::{Bindings, Pipelines, wrong_drawable};
use super::tsm::TranslucentShadowMaps;
use crate::error::Result;
use crate::frame::plan::Plan;
use crate::gpu::{FullscreenPass, Gpu, Rows, array_size};

/// Points within reach of a point, seldom more.
const NEIGHBOURS: u64 = 4_096;

/// Pipelines for materials of one layout.
#[derive(Debug)]
pub(crate) struct Passes {
    layout: MaterialLayout,
    irradiance: FullscreenPass,
    gather: FullscreenPass,
    shade: MeshPass,
}

/// Bind groups of the gather, and the light that its results are of.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    irradiance: [BindGroup; 2],
    gather: [BindGroup; 2],
    shade: BindGroup,
    /// Number of points that are bound.
    points: usize,
    /// Lights and environment of the exitance; none before the first gather.
    lit_by: Option<uniform::Scene>,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, layout: MaterialLayout, format: TextureFormat, samples: u32) -> Result<Self> {
        let targets = [gpu.target_texture_format()];
        let gather = table::SURFACE_GATHER.with(Choice::Material(layout));
        Ok(Self {
            layout,
            irradiance: FullscreenPass::new(gpu, table::IRRADIANCE.only(), &targets)?,
            gather: FullscreenPass::new(gpu, gather, &targets)?,
            shade: MeshPass::picture(gpu, table::SHADE_VERTEX.only(), format, samples)?,
        })
    }
}

impl Pipelines for Passes {
    fn shade(&self) -> &MeshPass {
        &self.shade
    }

    fn bind(
        self: Arc<Self>,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        common: &Common,
        _lights: &TranslucentShadowMaps,
        _plan: &Plan,
    ) -> Result<Box<dyn Bindings>> {
        let Drawable::Gather { mesh, points, material } = drawable else {
            return Err(wrong_drawable());
        };
        material.expect(self.layout)?;
        points.expect(mesh, points.count)?;
        let texture = BindingResource::TextureView;
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
                self.irradiance.bind(gpu, 0, &[common.block.as_entire_binding()])?,
                self.irradiance.bind(gpu, 1, &of_irradiance)?,
            ],
            gather: [self.gather.bind(gpu, 0, &material.resources())?, self.gather.bind(gpu, 1, &of_points)?],
            shade: self.shade.bind(gpu, 1, &of_shade)?,
            points: points.count,
            lit_by: None,
            passes: self,
        }))
    }
}

impl Bindings for Bound {
    /// Light that leaves the mesh: irradiance at every point, then Σ Rd(x_i, x_o) E(x_i) dA over their neighbours, unless
    /// it is known already.
    fn update(
        &mut self,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        _scene: &Scene,
        block: &uniform::Scene,
        _plan: &Plan,
    ) -> Result<()> {
        let Drawable::Gather { mesh, points, .. } = drawable else {
            return Err(wrong_drawable());
        };
        points.expect(mesh, self.points)?;
        let lit_by = lighting(block);
        if self.lit_by.is_some_and(|before| bytemuck::bytes_of(&before) == bytemuck::bytes_of(&lit_by)) {
            return Ok(());
        }
        let size = array_size(points.count);
        let [scene, of_points] = &self.irradiance;
        self.passes.irradiance.draw(gpu, &points.irradiance.view, &[scene, of_points], Rows::all(size))?;
        let [material, of_points] = &self.gather;
        for rows in Rows::bands(size, u64::from(ROW) * NEIGHBOURS) {
            self.passes.gather.draw(gpu, &points.exitance.view, &[material, of_points], rows)?;
        }
        self.lit_by = Some(lit_by);
        Ok(())
    }

    fn shade(&self) -> &BindGroup {
        &self.shade
    }
}

/// Block of a scene without what only the eye sees.
fn lighting(block: &uniform::Scene) -> uniform::Scene {
    let none = bytemuck::Zeroable::zeroed();
    let mut light = block.light;
    for source in &mut light {
        source.clip_from_world = [[0.0; 4]; 4];
    }
    uniform::Scene { eta: block.eta, lights: block.lights, sky: block.sky, light, ..none }
}
