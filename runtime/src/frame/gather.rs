//! The reference path: every vertex gathers from all others within reach.

use subsurf_scene::SurfacePoints;
use subsurf_shaders::source;
use subsurf_shaders::uniform::ROW;
use subsurf_shaders::{Storage, uniform};
use wgpu::{BindGroup, BindingResource, Buffer, TextureFormat};

use super::{COMMON, Common, encoding_of};
use crate::context::Gpu;
use crate::error::{Error, Result};
use crate::ledger::Tracked;
use crate::material::{Material, slots};
use crate::mesh::{GpuMesh, MeshPass};
use crate::pass::{CoverPass, Rows};
use crate::resource::{Slot, Surface2d, TextureSpec, array_size};

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

/// The points of a mesh on the device, and the light at them.
#[derive(Debug)]
pub struct GpuPoints {
    grid: Tracked<Buffer>,
    positions: Surface2d,
    normals: Surface2d,
    visibilities: Surface2d,
    pixels: Surface2d,
    cell_starts: Surface2d,
    irradiance: Surface2d,
    exitance: Surface2d,
    count: usize,
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

impl GpuPoints {
    /// Uploads the points of a mesh.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no textures of that size.
    pub fn upload(gpu: &Gpu, surface: &SurfacePoints) -> Result<Self> {
        let table = |label, len, format, bytes: &[u8]| gpu.filled(&TextureSpec::array(label, len, format), bytes);
        let target = |label| gpu.texture(&TextureSpec::target(label, array_size(surface.len()), gpu.kept()));
        let count = surface.len();
        let float = TextureFormat::Rgba32Float;
        Ok(Self {
            grid: gpu.uniform("grid", &uniform::Surface::new(surface)),
            positions: table("positions", count, float, bytemuck::cast_slice(&surface.positions))?,
            normals: table("normals", count, float, bytemuck::cast_slice(&surface.normals))?,
            visibilities: table("visibilities", count, float, bytemuck::cast_slice(&surface.visibilities))?,
            pixels: table("pixels", count, TextureFormat::Rg16Uint, bytemuck::cast_slice(&surface.pixels))?,
            cell_starts: table(
                "cell starts",
                surface.cell_starts.len(),
                TextureFormat::R32Uint,
                bytemuck::cast_slice(&surface.cell_starts),
            )?,
            irradiance: target("irradiance")?,
            exitance: target("exitance")?,
            count,
        })
    }

    /// Refuses points that are not those of a mesh, or not those of which there are `bound`.
    fn expect(&self, mesh: &GpuMesh, bound: usize) -> Result<()> {
        if mesh.points <= self.count && self.count == bound {
            return Ok(());
        }
        let (have, want) = (self.count, mesh.points.max(bound));
        Err(Error::Device(format!("{have} points for a mesh that names {want}: they are of another surface")))
    }

    /// Exitance of every point as it was last gathered, linear rgb.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>> {
        let mut texels = gpu.read_rgb(&self.exitance.texture)?;
        texels.truncate(self.count);
        Ok(texels)
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
