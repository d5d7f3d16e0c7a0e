//! The reference path: every vertex gathers from all others within reach.

use subsurf_shaders::uniform::ROW;
use subsurf_shaders::{Storage, source, uniform};
use wgpu::{BindGroup, BindingResource, TextureFormat};

use super::common::{COMMON, Common, encoding_of};
use super::mesh_pass::MeshPass;
use crate::asset::{GpuMesh, GpuPoints, Material, slots};
use crate::error::Result;
use crate::gpu::{CoverPass, Gpu, Rows, Slot, array_size};

/// A point seldom has more than this many others within reach.
const NEIGHBOURS: u64 = 4_096;

/// Its pipelines.
#[derive(Debug)]
pub(crate) struct Passes {
    storage: Storage,
    irradiance: CoverPass,
    gather: CoverPass,
    pub(crate) shade: MeshPass,
}

/// What is bound for one frame.
#[derive(Debug)]
pub(crate) struct Buffers {
    irradiance: [BindGroup; 2],
    gather: [BindGroup; 2],
    pub(crate) shade: BindGroup,
    /// How many are bound.
    points: usize,
    /// Lights and environment that the exitance is of.
    lit_by: Option<uniform::Scene>,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, storage: Storage, format: TextureFormat, samples: u32) -> Result<Self> {
        let of_points = [Slot::Uniform, Slot::Float, Slot::Uint, Slot::Uint, Slot::Kept];
        let of_irradiance: [&[Slot]; 2] = [&[Slot::Uniform], &[Slot::Float, Slot::Float, Slot::Float]];
        let of_shade = [Slot::Kept, Slot::Float];
        let gather = source::surface_gather(storage);
        let shade = source::shade_points(encoding_of(format));
        Ok(Self {
            storage,
            irradiance: CoverPass::new(gpu, source::IRRADIANCE, "irradiance", &of_irradiance, &[gpu.kept()])?,
            gather: CoverPass::new(gpu, gather, "surface_gather", &[slots(storage), &of_points], &[gpu.kept()])?,
            shade: MeshPass::new(gpu, shade, "shade", &[&COMMON, &of_shade], &[format], samples)?,
        })
    }
}

impl Buffers {
    pub(crate) fn new(
        gpu: &Gpu,
        passes: &Passes,
        mesh: &GpuMesh,
        material: &Material,
        points: &GpuPoints,
        common: &Common,
    ) -> Result<Self> {
        material.expect(passes.storage)?;
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
        Ok(Self {
            irradiance: [
                passes.irradiance.bind(gpu, 0, &[common.block.as_entire_binding()])?,
                passes.irradiance.bind(gpu, 1, &of_irradiance)?,
            ],
            gather: [passes.gather.bind(gpu, 0, &material.resources())?, passes.gather.bind(gpu, 1, &of_points)?],
            shade: passes.shade.bind(gpu, 1, &of_shade)?,
            points: points.count,
            lit_by: None,
        })
    }

    /// Light that leaves the mesh: irradiance at every point, then Σ Rd(x_i, x_o) E(x_i) dA over their neighbours, unless
    /// it is known already.
    pub(crate) fn gather(
        &mut self,
        gpu: &Gpu,
        passes: &Passes,
        mesh: &GpuMesh,
        points: &GpuPoints,
        block: &uniform::Scene,
    ) -> Result<()> {
        points.expect(mesh, self.points)?;
        let lit_by = lighting(block);
        if self.lit_by.is_some_and(|before| bytemuck::bytes_of(&before) == bytemuck::bytes_of(&lit_by)) {
            return Ok(());
        }
        let size = array_size(points.count);
        let [scene, of_points] = &self.irradiance;
        passes.irradiance.draw(gpu, &points.irradiance.view, &[scene, of_points], Rows::all(size))?;
        let [material, of_points] = &self.gather;
        for rows in Rows::bands(size, u64::from(ROW) * NEIGHBOURS) {
            passes.gather.draw(gpu, &points.exitance.view, &[material, of_points], rows)?;
        }
        self.lit_by = Some(lit_by);
        Ok(())
    }
}

/// A scene's block without what only the eye sees.
fn lighting(block: &uniform::Scene) -> uniform::Scene {
    let none = bytemuck::Zeroable::zeroed();
    let mut light = block.light;
    for source in &mut light {
        source.clip_from_world = [[0.0; 4]; 4];
    }
    uniform::Scene { eta: block.eta, lights: block.lights, sky: block.sky, light, ..none }
}
