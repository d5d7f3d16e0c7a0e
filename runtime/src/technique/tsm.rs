//! Translucent shadow maps: what each light sees of the objects, as positions, light that enters, and places on the patch.

use subsurf_shaders::passes::table;
use subsurf_shaders::uniform::TsmLight;
use wgpu::{BindGroup, Buffer, Color, CommandEncoder, TextureView};

use super::mesh_pass::{Attachments, DepthFormat, Draw, MeshPass, cleared};
use crate::error::Result;
use crate::frame::{Plan, light_layers};
use crate::gpu::{DEPTH, Gpu, Surface2d, TextureSpec, Tracked, layers_of, level_of};

/// Position where nothing is seen: 60 m away, nearly the largest that half floats hold.
pub(crate) const FAR: Color = Color { r: 0.0, g: 0.0, b: 0.0, a: 60_000.0 };

/// Depth of what lights see.
const LIGHT_DEPTH: DepthFormat = DepthFormat { format: DEPTH, is_reversed: false };

/// Positions, fluxes and places that lights see, a layer for each light.
#[derive(Debug)]
pub(crate) struct TranslucentShadowMaps {
    surfaces: [Surface2d; 3],
    /// View of all layers and levels of each.
    pub(crate) all: [TextureView; 3],
    /// Of each light, views of its layers at the finest level.
    targets: Vec<[TextureView; 3]>,
    depth: Surface2d,
    numbers: Vec<(Tracked<Buffer>, BindGroup)>,
    scene: BindGroup,
    /// What positions are cleared to.
    far: Color,
}

/// Compiles the pass.
pub(crate) fn pass(gpu: &Gpu) -> Result<MeshPass> {
    MeshPass::new(gpu, table::TSM_RENDER.only(), &[gpu.target_texture_format(); 3], LIGHT_DEPTH)
}

impl TranslucentShadowMaps {
    pub(crate) fn new(gpu: &Gpu, pass: &MeshPass, scene: &Buffer, plan: &Plan) -> Result<Self> {
        let size = [plan.light_texels; 2];
        let layers = light_layers(plan.lights);
        let surface = |label| {
            gpu.texture(&TextureSpec {
                layers,
                levels: plan.light_levels(),
                ..TextureSpec::target(label, size, gpu.target_texture_format())
            })
        };
        let surfaces = [surface("positions seen")?, surface("fluxes seen")?, surface("places seen")?];
        let of_light = |layer| [0, 1, 2].map(|k| level_of(&surfaces[k], layer, 0));
        let numbers = |light| {
            let block = TsmLight { light, group: 0.0, level: 0, pad: 0 };
            let block: Tracked<Buffer> = gpu.uniform("light of a shadow map", &block);
            let group = pass.bind(gpu, 1, &[block.as_entire_binding()])?;
            Ok((block, group))
        };
        Ok(Self {
            all: [0, 1, 2].map(|k| layers_of(&surfaces[k])),
            targets: (0..plan.lights.min(layers)).map(of_light).collect(),
            depth: gpu.texture(&TextureSpec::attachment("light depth", size, DEPTH))?,
            numbers: (0..plan.lights.min(layers)).map(numbers).collect::<Result<_>>()?,
            scene: pass.bind(gpu, 0, &[scene.as_entire_binding()])?,
            surfaces,
            far: gpu.clear_colour(FAR),
        })
    }

    /// Records what the first `lights` lights see of some objects, at the finest level.
    pub(crate) fn record<'m, I: Iterator<Item = Draw<'m>>>(
        &self,
        encoder: &mut CommandEncoder,
        pass: &MeshPass,
        lights: u32,
        objects: &BindGroup,
        draws: impl Fn() -> I,
    ) {
        for (views, (_, numbers)) in self.targets.iter().zip(&self.numbers).take(lights as usize) {
            let clears = [self.far, Color::TRANSPARENT, Color::TRANSPARENT];
            let attachments = Attachments {
                colours: &[0, 1, 2].map(|k| cleared(&views[k], clears[k])),
                depth: &self.depth.view,
                depth_ops: LIGHT_DEPTH.own(),
                viewport: None,
            };
            pass.record(encoder, &attachments, [&self.scene, numbers], objects, draws());
        }
    }

    /// Textures of positions, fluxes and places.
    pub(crate) fn surfaces(&self) -> &[Surface2d; 3] {
        &self.surfaces
    }
}
