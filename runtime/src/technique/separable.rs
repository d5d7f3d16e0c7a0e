//! The separable technique: weighted irradiance where the eye sees the meshes, blurred on the screen by distances in space.

use std::sync::Arc;

use subsurf_decoder::bssrdf::basis::MAX_TERMS;
use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::uniform::{ScreenDomain, Upsampling};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder};

use super::area::{self, MapArea};
use super::bindings::{Bindings, Group, Lap};
use super::cascade::{BlurPasses, Cascade, CascadeMaps};
use super::common::Common;
use super::mesh_pass::{Attachments, DepthFormat, MeshPass, SharedGroups, cleared};
use super::tsm::{FAR_MM, TranslucentShadowMaps};
use super::volume::{self, Volume};
use crate::asset::SeparableMaterial;
use crate::error::{Error, Result};
use crate::frame::{Plan, RuntimeOptions};
use crate::gpu::{FullscreenPass, Gpu, Purpose, Surface2d, TextureSpec, Tracked};

/// Texels of the narrowest Gaussian, σ, at the middle of the scene: maps are made as coarse as that.
const NARROWEST_TEXELS: f32 = 0.8;

/// Pipelines for materials of one number of terms.
#[derive(Debug)]
pub(crate) struct Passes {
    depth: DepthFormat,
    volume: volume::Passes,
    gbuffer: MeshPass,
    blur: BlurPasses,
    last: FullscreenPass,
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
    volume: Volume,
    domain: Tracked<Buffer>,
    upsampling: Tracked<Buffer>,
    gbuffer: [BindGroup; 2],
    shade: BindGroup,
    pitch_mm: f32,
    /// Area of the maps in the last frame.
    area: MapArea,
    /// What maps hold where nothing is seen.
    far: Color,
}

/// Pixels of the picture to a side of a texel of the maps, when a mm of the material covers `pixels_per_mm`.
pub(crate) fn divisor(material: &SeparableMaterial, pixels_per_mm: f32) -> f32 {
    divisor_of(material.narrowest_pixels(), material.header().pitch_mm, pixels_per_mm)
}

/// The same where the narrowest Gaussian has so many pixels of the material of a pitch in mm.
pub(crate) fn divisor_of(narrowest_pixels: f32, pitch_mm: f32, pixels_per_mm: f32) -> f32 {
    area::divisor_of(narrowest_pixels * pitch_mm * pixels_per_mm / NARROWEST_TEXELS, 4.0)
}

impl Maps {
    /// Width and height of maps that have so many texels, and room for the light volume first.
    fn room(size: [u32; 2]) -> [u32; 2] {
        [0, 1].map(|k| size[k].max(volume::TEXELS[k]))
    }

    /// Bytes on the device of maps of so many texels.
    pub(crate) fn bytes_of(size: [u32; 2], terms: usize, options: &RuntimeOptions) -> u64 {
        let size = Self::room(size);
        CascadeMaps::bytes_of(size, terms) + TextureSpec::attachment("", size, options.depth.format).bytes()
    }

    pub(crate) fn new(gpu: &Gpu, plan: &Plan, options: &RuntimeOptions, terms: usize) -> Result<Self> {
        let size = Self::room(plan.blur_size);
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
            volume: volume::Passes::new(gpu, terms)?,
            gbuffer: MeshPass::lit(gpu, table::SEPARABLE_GBUFFER.with(choice), &maps, options)?,
            blur: BlurPasses::new(gpu, [&table::BLUR_SCREEN, &table::SUM_SCREEN], terms)?,
            last: FullscreenPass::new(gpu, table::BLUR_SCREEN_LAST.with(choice), &maps[..terms])?,
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
        let domain = gpu.uniform(Purpose::Frame, "screen", &ScreenDomain::default());
        let last = (&self.last, None);
        let cascade = Cascade::new(gpu, &self.blur, None, last, material, &domain.as_entire_binding(), &maps.cascade)?;
        let upsampling = gpu.uniform(Purpose::Frame, "upsampling", &Upsampling::default());
        let texture = BindingResource::TextureView;
        let basis = material.layers.resources();
        let volume = Volume::new(gpu, &self.volume, material, common, lights, &maps.cascade)?;
        let [of_volume, spread] = volume.resources();
        let of_gbuffer = [
            basis[0].clone(),
            basis[1].clone(),
            material.transmission(),
            texture(lights.views()[1]),
            texture(lights.views()[2]),
            of_volume,
            spread,
        ];
        let of_scene = [common.scene.as_entire_binding(), texture(lights.views()[0])];
        let of_shade = [basis[0].clone(), basis[1].clone(), upsampling.as_entire_binding(), maps.cascade.sums().all()];
        Ok(Box::new(Bound {
            gbuffer: [self.gbuffer.bind(gpu, 0, &of_scene)?, self.gbuffer.bind(gpu, 1, &of_gbuffer)?],
            shade: self.shade.bind(gpu, 1, &of_shade)?,
            far: gpu.clear_colour(Color { r: 0.0, g: 0.0, b: 0.0, a: FAR_MM }),
            pitch_mm: material.header().pitch_mm,
            area: MapArea::default(),
            maps: maps.clone(),
            cascade,
            volume,
            domain,
            upsampling,
            passes: self.clone(),
        }))
    }
}

impl Bindings for Bound {
    /// Tells the passes how large things are on the screen.
    fn update(&mut self, gpu: &Gpu, group: &Group<'_>) {
        let (view, plan) = (&group.input.view, group.plan);
        self.area = MapArea::over(view, &group.bounds, plan.size, plan.blur_size, plan.divisor);
        let domain = group.screen(&self.area, self.pitch_mm, false);
        gpu.queue.write_buffer(&self.domain, 0, bytemuck::bytes_of(&domain));
        gpu.queue.write_buffer(&self.upsampling, 0, bytemuck::bytes_of(&group.upsampling(&self.area)));
        self.volume.update(gpu, group, self.pitch_mm);
    }

    fn record(&self, encoder: &mut CommandEncoder, group: &Group<'_>, shared: SharedGroups<'_>, lap: Lap<'_>) {
        let Maps { cascade: maps, depth } = &*self.maps;
        let layers = maps.irradiance().layers.iter().chain(&maps.begun_sums().layers);
        let colours: Vec<_> = layers.map(|view| cleared(view, self.far)).collect();
        let attachments = Attachments {
            colours: &colours,
            depth: &depth.view,
            depth_ops: self.passes.depth.own(),
            viewport: Some(self.area.viewport()),
        };
        let [scene, basis] = &self.gbuffer;
        let Passes { gbuffer, blur, last, volume, .. } = &*self.passes;
        self.volume.record(encoder, volume, lap);
        gbuffer.record(encoder, &attachments, [scene, basis], shared, group.draws());
        lap(gbuffer.name(), encoder);
        let targets: Vec<_> = maps.sums().layers.iter().collect();
        let stages = self.volume.first();
        self.cascade.record(encoder, (self.area.size, stages), blur, None, (last, &targets), lap);
    }

    fn shade(&self) -> (&MeshPass, &BindGroup) {
        (&self.passes.shade, &self.shade)
    }
}
