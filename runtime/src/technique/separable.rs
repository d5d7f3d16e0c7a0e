//! The separable technique: weighted irradiance where the eye sees the meshes, blurred on the screen by distances in space.

use std::sync::Arc;

use subsurf_decoder::bssrdf::basis::MAX_TERMS;
use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::{ScreenDomain, Upsampling};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder};

use super::bindings::{Bindings, Group, Lap};
use super::cascade::{BlurPasses, Cascade, CascadeMaps};
use super::common::Common;
use super::mesh_pass::{Attachments, DepthFormat, MeshPass, SharedGroups, cleared};
use super::tsm::{FAR_MM, TranslucentShadowMaps};
use crate::asset::SeparableMaterial;
use crate::error::{Error, Result};
use crate::frame::{Plan, RuntimeOptions};
use crate::gpu::{Gpu, Surface2d, TextureSpec, Tracked};

/// Texels of the narrowest Gaussian, σ, at the middle of the scene: maps are made as coarse as that.
const NARROWEST_TEXELS: f32 = 0.8;

/// Pipelines for materials of one number of terms.
#[derive(Debug)]
pub(crate) struct Passes {
    depth: DepthFormat,
    gbuffer: MeshPass,
    blur: BlurPasses,
    shade: MeshPass,
}

/// Maps for one size of picture, which materials use one after the other.
#[derive(Debug)]
pub(crate) struct Maps {
    cascade: Arc<CascadeMaps>,
    depth: Surface2d,
}

/// Blocks and bind groups of one material.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    maps: Arc<Maps>,
    cascade: Cascade,
    domain: Tracked<Buffer>,
    upsampling: Tracked<Buffer>,
    gbuffer: [BindGroup; 2],
    shade: BindGroup,
    pitch_mm: f32,
    /// What maps hold where nothing is seen.
    far: Color,
}

/// Pixels of the picture to a side of a texel of the maps, when a mm of the material covers `pixels_per_mm`.
pub(crate) fn divisor(material: &SeparableMaterial, pixels_per_mm: f32) -> u32 {
    let narrowest = material.narrowest_pixels() * material.header().pitch_mm * pixels_per_mm;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let divisor = (narrowest / NARROWEST_TEXELS).clamp(1.0, 4.0) as u32;
    // Of what is no number nothing is left.
    divisor.max(1)
}

impl Maps {
    /// Bytes on the device.
    pub(crate) fn bytes_of(plan: &Plan, options: &RuntimeOptions, terms: usize) -> u64 {
        let size = plan.map_size();
        CascadeMaps::bytes_of(size, terms) + TextureSpec::attachment("", size, options.depth.format).bytes()
    }

    pub(crate) fn new(gpu: &Gpu, plan: &Plan, options: &RuntimeOptions, terms: usize) -> Result<Self> {
        let size = plan.map_size();
        Ok(Self {
            cascade: Arc::new(CascadeMaps::new(gpu, size, terms)?),
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, options.depth.format))?,
        })
    }
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, terms: usize, options: &RuntimeOptions) -> Result<Self> {
        if !(1..=MAX_TERMS).contains(&terms) {
            return Err(Error::Usage(format!("L = {terms}; a basis has 1 to {MAX_TERMS} terms")));
        }
        let choice = Choice::Terms(terms);
        let maps = vec![gpu.target_texture_format(); 2 * terms];
        Ok(Self {
            depth: options.depth,
            gbuffer: MeshPass::lit(gpu, table::SEPARABLE_GBUFFER.with(choice), &maps, options)?,
            blur: BlurPasses::new(gpu, [&table::BLUR_SCREEN_ROWS, &table::BLUR_SCREEN_COLUMNS], terms)?,
            shade: MeshPass::picture(gpu, table::SHADE_SEPARABLE.with(choice), options)?,
        })
    }

    /// Binds a material to the maps of a frame.
    pub(crate) fn bind(
        self: &Arc<Self>,
        gpu: &Gpu,
        material: &SeparableMaterial,
        common: &Common,
        lights: &TranslucentShadowMaps,
        maps: &Arc<Maps>,
    ) -> Result<Box<dyn Bindings>> {
        let domain = gpu.uniform("screen", &ScreenDomain::default());
        let cascade = Cascade::new(gpu, &self.blur, material, &domain.as_entire_binding(), &maps.cascade)?;
        let upsampling = gpu.uniform("upsampling", &Upsampling::default());
        let texture = BindingResource::TextureView;
        let basis = [texture(&material.layers.all), BindingResource::Sampler(&material.layers.sampler)];
        let of_gbuffer = [
            basis[0].clone(),
            basis[1].clone(),
            material.transmission().as_entire_binding(),
            texture(lights.views()[1]),
            texture(lights.views()[2]),
        ];
        let of_scene = [common.scene.as_entire_binding(), texture(lights.views()[0])];
        let sums = &cascade.sums().all;
        let of_shade = [basis[0].clone(), basis[1].clone(), upsampling.as_entire_binding(), texture(sums)];
        Ok(Box::new(Bound {
            gbuffer: [self.gbuffer.bind(gpu, 0, &of_scene)?, self.gbuffer.bind(gpu, 1, &of_gbuffer)?],
            shade: self.shade.bind(gpu, 1, &of_shade)?,
            far: gpu.clear_colour(Color { r: 0.0, g: 0.0, b: 0.0, a: FAR_MM }),
            pitch_mm: material.header().pitch_mm,
            maps: maps.clone(),
            cascade,
            domain,
            upsampling,
            passes: self.clone(),
        }))
    }
}

impl Bindings for Bound {
    /// Tells the passes how large things are on the screen.
    fn update(&mut self, gpu: &Gpu, group: &Group<'_>) {
        let view = &group.input.view;
        let domain = ScreenDomain {
            size: group.plan.map_size(),
            focal_texels: group.plan.texels_per_tangent(view).map(|texels| texels * self.pitch_mm),
            middle_mm: group.middle_mm(),
            pitch_mm: self.pitch_mm,
            perspective: if view.is_parallel() { 0.0 } else { 1.0 },
            pad: 0,
        };
        gpu.queue.write_buffer(&self.domain, 0, bytemuck::bytes_of(&domain));
        gpu.queue.write_buffer(&self.upsampling, 0, bytemuck::bytes_of(&group.upsampling()));
    }

    fn record(&self, encoder: &mut CommandEncoder, group: &Group<'_>, shared: SharedGroups<'_>, lap: Lap<'_>) {
        let layers = self.cascade.maps.irradiance[0].layers.iter().chain(&self.cascade.begun_sums().layers);
        let colours: Vec<_> = layers.map(|view| cleared(view, self.far)).collect();
        let attachments = Attachments {
            colours: &colours,
            depth: &self.maps.depth.view,
            depth_ops: self.passes.depth.own(),
            viewport: None,
        };
        let [scene, basis] = &self.gbuffer;
        self.passes.gbuffer.record(encoder, &attachments, [scene, basis], shared, group.draws());
        lap("gbuffer", encoder);
        self.cascade.record(encoder, &self.passes.blur, None);
        lap("blur", encoder);
    }

    fn shade(&self) -> (&MeshPass, &BindGroup) {
        (&self.passes.shade, &self.shade)
    }
}
