//! The separable technique: weighted irradiance where the eye sees the mesh, blurred on the screen by distances in space.

use std::sync::Arc;

use subsurf_decoder::bssrdf::basis::MAX_TERMS;
use subsurf_scene::{Placement, Scene};
use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::{self, ScreenDomain, Upsampling};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder, TextureFormat};

use super::cascade::{BlurPasses, Cascade};
use super::common::{Common, Lap};
use super::drawable::Drawable;
use super::mesh_pass::{MeshPass, Target};
use super::pipelines::{Bindings, Pipelines, wrong_drawable};
use super::tsm::{FAR, TranslucentShadowMaps};
use crate::asset::GpuMesh;
use crate::error::{Error, Result};
use crate::frame::plan::Plan;
use crate::gpu::{DEPTH, Gpu, Surface2d, TextureSpec, Tracked};

/// Texels of the narrowest Gaussian, σ, at the middle of the scene: maps are made as coarse as that.
const NARROWEST_TEXELS: f32 = 0.8;

/// Pipelines for materials of one number of terms.
#[derive(Debug)]
pub(crate) struct Passes {
    terms: usize,
    gbuffer: MeshPass,
    blur: BlurPasses,
    shade: MeshPass,
}

/// Maps and blocks for one size of picture.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    cascade: Cascade,
    depth: Surface2d,
    domain: Tracked<Buffer>,
    upsampling: Tracked<Buffer>,
    gbuffer: [BindGroup; 2],
    shade: BindGroup,
    /// What maps hold where nothing is seen.
    far: Color,
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, terms: usize, format: TextureFormat, samples: u32) -> Result<Self> {
        if !(1..=MAX_TERMS).contains(&terms) {
            return Err(Error::Device(format!("L = {terms}; a basis has 1 to {MAX_TERMS} terms")));
        }
        let choice = Choice::Terms(terms);
        let maps = vec![gpu.target_texture_format(); 2 * terms];
        Ok(Self {
            terms,
            gbuffer: MeshPass::new(gpu, table::SEPARABLE_GBUFFER.with(choice), &maps)?,
            blur: BlurPasses::new(gpu, [&table::BLUR_SCREEN_ROWS, &table::BLUR_SCREEN_COLUMNS], terms)?,
            shade: MeshPass::picture(gpu, table::SHADE_SEPARABLE.with(choice), format, samples)?,
        })
    }
}

impl Pipelines for Passes {
    fn bytes(&self, plan: &Plan, _placement: &Placement) -> u64 {
        let size = plan.map_size();
        let depth = TextureSpec::target("", size, DEPTH).bytes();
        Cascade::bytes_of(size, self.terms) + depth + plan.light_bytes(1)
    }

    fn divisor(&self, drawable: &Drawable<'_>, _light_texels: u32, pixels_per_mm: f32) -> u32 {
        let Drawable::Separable { mesh, material } = drawable else {
            return 1;
        };
        let narrowest = material.narrowest_pixels() * mesh.placement.pitch_mm * pixels_per_mm;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let divisor = (narrowest / NARROWEST_TEXELS).clamp(1.0, 4.0) as u32;
        // Of what is no number nothing is left.
        divisor.max(1)
    }

    fn shade(&self) -> &MeshPass {
        &self.shade
    }

    fn bind(
        self: Arc<Self>,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        common: &Common,
        lights: &TranslucentShadowMaps,
        plan: &Plan,
    ) -> Result<Box<dyn Bindings>> {
        let Drawable::Separable { material, .. } = drawable else {
            return Err(wrong_drawable());
        };
        material.expect(self.terms)?;
        let size = plan.map_size();
        let domain = gpu.uniform("screen", &ScreenDomain::default());
        let cascade = Cascade::new(gpu, &self.blur, material, &domain.as_entire_binding(), size)?;
        let upsampling = gpu.uniform("upsampling", &Upsampling::default());
        let texture = BindingResource::TextureView;
        let basis = [texture(&material.layers.all), BindingResource::Sampler(&material.layers.sampler)];
        let of_gbuffer = [
            basis[0].clone(),
            basis[1].clone(),
            material.transmission().as_entire_binding(),
            texture(&lights.all[1]),
            texture(&lights.all[2]),
        ];
        let of_scene = [common.block.as_entire_binding(), texture(&lights.all[0])];
        let of_shade =
            [basis[0].clone(), basis[1].clone(), upsampling.as_entire_binding(), texture(&cascade.sums().all)];
        Ok(Box::new(Bound {
            gbuffer: [self.gbuffer.bind(gpu, 0, &of_scene)?, self.gbuffer.bind(gpu, 1, &of_gbuffer)?],
            shade: self.shade.bind(gpu, 1, &of_shade)?,
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, DEPTH))?,
            far: gpu.clear_colour(FAR),
            cascade,
            domain,
            upsampling,
            passes: self,
        }))
    }
}

impl Bindings for Bound {
    /// Tells the passes how large things are on the screen.
    fn update(
        &mut self,
        gpu: &Gpu,
        drawable: &Drawable<'_>,
        scene: &Scene,
        block: &uniform::Scene,
        plan: &Plan,
    ) -> Result<()> {
        let Drawable::Separable { .. } = drawable else {
            return Err(wrong_drawable());
        };
        let domain = ScreenDomain {
            size: plan.map_size(),
            focal_texels: plan.texels_per_tangent(&scene.camera) * block.pitch_mm,
            middle_mm: block.middle_mm,
            pitch_mm: block.pitch_mm,
            pad: [0; 3],
        };
        gpu.queue.write_buffer(&self.domain, 0, bytemuck::bytes_of(&domain));
        let upsampling = plan.upsampling(&scene.camera, block.middle_mm);
        gpu.queue.write_buffer(&self.upsampling, 0, bytemuck::bytes_of(&upsampling));
        Ok(())
    }

    fn record(
        &self,
        mut encoder: CommandEncoder,
        mesh: &GpuMesh,
        _lights: usize,
        _plan: &Plan,
        lap: Lap<'_>,
    ) -> CommandEncoder {
        let layers = self.cascade.maps[0].layers.iter().chain(&self.cascade.begun_sums().layers);
        let targets: Vec<_> = layers.map(|view| Target { view, clear: self.far, resolved: None }).collect();
        let [scene, basis] = &self.gbuffer;
        self.passes.gbuffer.record(&mut encoder, &targets, &self.depth.view, &[scene, basis], mesh);
        encoder = lap("gbuffer", encoder);
        self.cascade.record(&mut encoder, &self.passes.blur, None);
        lap("blur", encoder)
    }

    fn shade(&self) -> &BindGroup {
        &self.shade
    }
}
