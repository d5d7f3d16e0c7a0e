//! Translucent shadow maps: what each light sees of the objects, as positions, light that enters, and places on the patch.

use subsurf_shaders::TargetFormat;
use subsurf_shaders::passes::table;
use subsurf_shaders::uniform::TsmLight;
use wgpu::{BindGroup, Buffer, Color, CommandEncoder, TextureFormat, TextureView};

use super::mesh_pass::{Attachments, DepthFormat, Draw, MeshPass, Viewport, cleared};
use crate::error::Result;
use crate::frame::Plan;
use crate::gpu::{Gpu, Purpose, Surface2d, TextureSpec, Tracked, level_of};

/// Depth where nothing is seen: 60 m away, nearly the largest that half floats hold.
pub(crate) const FAR_MM: f64 = 60_000.0;

/// Depth of what lights see, by which the nearest is kept: 16 bits. Of a light within the scene they are coarse far from it.
const LIGHT_DEPTH: DepthFormat = DepthFormat { format: TextureFormat::Depth16Unorm, is_reversed: false };

/// Depths and positions, fluxes and places that lights see, a square tile for each light, row by row.
#[derive(Debug)]
pub(crate) struct TranslucentShadowMaps {
    surfaces: [Surface2d; 3],
    /// Views of the finest level of each.
    targets: [TextureView; 3],
    depth: Surface2d,
    tiles: Vec<Tile>,
    scene: BindGroup,
    /// What depth is cleared to.
    far: Color,
}

/// Tile of a light.
#[derive(Debug)]
struct Tile {
    block: Tracked<Buffer>,
    group: BindGroup,
    viewport: Viewport,
}

/// Pipelines that draw the maps: those from which splats are drawn have positions and ranges of depth besides.
#[derive(Debug)]
pub(crate) struct TsmPasses {
    plain: MeshPass,
    with_positions: MeshPass,
}

/// Formats of the three targets.
fn formats(gpu: &Gpu, has_positions: bool) -> [TextureFormat; 3] {
    let whole = gpu.target_texture_format();
    match (has_positions, gpu.target_format()) {
        (true, _) => [whole; 3],
        (false, TargetFormat::Half) => [TextureFormat::R16Float, whole, TextureFormat::Rg16Float],
        (false, TargetFormat::Packed) => [TextureFormat::R16Uint, whole, TextureFormat::Rg16Uint],
    }
}

/// Textures of the three targets, and that of depth.
fn specs(gpu: &Gpu, plan: &Plan) -> [TextureSpec; 4] {
    let (size, purpose) = (plan.light_size(), Purpose::LightView);
    let [positions, fluxes, places] = formats(gpu, plan.has_light_levels);
    let target = |label, format| TextureSpec {
        purpose,
        levels: plan.light_levels(),
        ..TextureSpec::target(label, size, format)
    };
    [
        target("positions seen", positions),
        target("fluxes seen", fluxes),
        target("places seen", places),
        TextureSpec { purpose, ..TextureSpec::attachment("light depth", size, LIGHT_DEPTH.format) },
    ]
}

impl TsmPasses {
    pub(crate) fn new(gpu: &Gpu) -> Result<Self> {
        let pass =
            |has_positions| MeshPass::new(gpu, table::TSM_RENDER.only(), &formats(gpu, has_positions), LIGHT_DEPTH);
        Ok(Self { plain: pass(false)?, with_positions: pass(true)? })
    }

    /// Pipeline for maps of a plan.
    pub(crate) fn of(&self, plan: &Plan) -> &MeshPass {
        if plan.has_light_levels { &self.with_positions } else { &self.plain }
    }
}

impl TranslucentShadowMaps {
    /// Bytes on the device.
    pub(crate) fn bytes_of(gpu: &Gpu, plan: &Plan) -> u64 {
        specs(gpu, plan).iter().map(TextureSpec::bytes).sum()
    }

    /// Makes the maps, to be drawn by a pass for them.
    pub(crate) fn new(gpu: &Gpu, pass: &MeshPass, scene: &Buffer, plan: &Plan) -> Result<Self> {
        let [positions, fluxes, places, depth] = specs(gpu, plan);
        let surfaces = [gpu.texture(&positions)?, gpu.texture(&fluxes)?, gpu.texture(&places)?];
        let tile = |number| {
            let block: Tracked<Buffer> = gpu.uniform(Purpose::Frame, "tile of a light", &TsmLight::default());
            let group = pass.bind(gpu, 1, &[block.as_entire_binding()])?;
            Ok(Tile { block, group, viewport: Viewport::at(plan.tile(number), [plan.light_texels; 2]) })
        };
        Ok(Self {
            targets: surfaces.each_ref().map(|surface| level_of(surface, 0, 0)),
            depth: gpu.texture(&depth)?,
            tiles: (0..plan.lights).map(tile).collect::<Result<_>>()?,
            scene: pass.bind(gpu, 0, &[scene.as_entire_binding()])?,
            surfaces,
            far: gpu.clear_colour(Color { r: FAR_MM, g: 0.0, b: 0.0, a: 0.0 }),
        })
    }

    /// Tells every tile the number of its light.
    pub(crate) fn update(&self, gpu: &Gpu, lights: impl Iterator<Item = u32>) {
        for (tile, light) in self.tiles.iter().zip(lights) {
            let block = TsmLight { light, ..Default::default() };
            gpu.queue.write_buffer(&tile.block, 0, bytemuck::bytes_of(&block));
        }
    }

    /// Records what the lights of the first tiles see of some objects, at the finest level.
    pub(crate) fn record<'m, I: Iterator<Item = Draw<'m>>>(
        &self,
        encoder: &mut CommandEncoder,
        pass: &MeshPass,
        tiles: usize,
        objects: &BindGroup,
        draws: impl Fn() -> I,
    ) {
        if tiles == 0 {
            return;
        }
        let clears = [self.far, Color::TRANSPARENT, Color::TRANSPARENT];
        let attachments = Attachments {
            colours: &[0, 1, 2].map(|k| cleared(&self.targets[k], clears[k])),
            depth: &self.depth.view,
            depth_ops: LIGHT_DEPTH.own(),
            viewport: None,
        };
        let parts = self.tiles[..tiles].iter().map(|tile| (&tile.group, tile.viewport));
        pass.record_parts(encoder, &attachments, &self.scene, parts, objects, draws);
    }

    /// Views of all levels of positions, fluxes and places.
    pub(crate) fn views(&self) -> [&TextureView; 3] {
        self.surfaces.each_ref().map(|surface| &surface.view)
    }

    /// Textures of positions, fluxes and places.
    pub(crate) fn surfaces(&self) -> &[Surface2d; 3] {
        &self.surfaces
    }
}
