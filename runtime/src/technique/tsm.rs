//! Translucent shadow maps: what each light sees of a mesh, as positions, light that enters, and places on the patch.

use subsurf_shaders::passes::table;
use subsurf_shaders::uniform::TsmLight;
use wgpu::{BindGroup, Buffer, Color, CommandEncoder, TextureView};

use super::mesh_pass::{MeshPass, Target};
use crate::asset::GpuMesh;
use crate::error::Result;
use crate::frame::plan::{Plan, light_layers};
use crate::gpu::{DEPTH, Gpu, Surface2d, TextureSpec, Tracked, layers_of, level_of};

/// Position where nothing is seen: 60 m away, nearly the largest that half floats hold.
pub(crate) const FAR: Color = Color { r: 0.0, g: 0.0, b: 0.0, a: 60_000.0 };

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
    MeshPass::new(gpu, table::TSM_RENDER.only(), &[gpu.target_texture_format(); 3])
}

impl TranslucentShadowMaps {
    pub(crate) fn new(gpu: &Gpu, pass: &MeshPass, scene: &Buffer, plan: &Plan, levels: u32) -> Result<Self> {
        let size = [plan.light_texels; 2];
        let layers = light_layers(plan.lights);
        let surface = |label| {
            gpu.texture(&TextureSpec {
                layers,
                levels,
                ..TextureSpec::target(label, size, gpu.target_texture_format())
            })
        };
        let surfaces = [surface("positions seen")?, surface("fluxes seen")?, surface("places seen")?];
        let of_light = |layer| [0, 1, 2].map(|k| level_of(&surfaces[k], layer, 0));
        let numbers = |light| {
            let block: Tracked<Buffer> = gpu.uniform("light of a shadow map", &TsmLight { light, pad: [0; 3] });
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

    /// Records what the first `lights` lights see, at the finest level.
    pub(crate) fn record(&self, encoder: &mut CommandEncoder, pass: &MeshPass, mesh: &GpuMesh, lights: usize) {
        for (views, (_, numbers)) in self.targets.iter().zip(&self.numbers).take(lights) {
            let clears = [self.far, Color::TRANSPARENT, Color::TRANSPARENT];
            let targets = [0, 1, 2].map(|k| Target { view: &views[k], clear: clears[k], resolved: None });
            pass.record(encoder, &targets, &self.depth.view, &[&self.scene, numbers], mesh);
        }
    }

    /// Textures of positions, fluxes and places.
    pub(crate) fn surfaces(&self) -> &[Surface2d; 3] {
        &self.surfaces
    }
}
