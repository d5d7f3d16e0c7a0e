//! Separable kernels of homogeneous materials: light where the eye sees the meshes, blurred on the screen along rows and columns.
//!
//! Terms are drawn one after the other, each by two passes, so that any number of them takes the same pipelines and one target to a pass.

use std::sync::Arc;

use subsurf_shaders::passes::kernel;
use subsurf_shaders::uniform::{ScreenDomain, Upsampling};
use wgpu::{BindGroup, BindingResource, Buffer, Color, CommandEncoder};

use super::area::{self, MapArea};
use super::bindings::{Bindings, Group, Lap};
use super::common::Common;
use super::mesh_pass::{Attachments, DepthFormat, MeshPass, SharedGroups, cleared};
use super::tsm::{FAR_MM, TranslucentShadowMaps};
use crate::asset::KernelMaterial;
use crate::error::Result;
use crate::frame::{Plan, RuntimeOptions};
use crate::gpu::{FullscreenPass, Gpu, HALF, Purpose, Rows, Surface2d, TextureSpec, Tracked};

/// Pipelines for all kernels.
#[derive(Debug)]
pub(crate) struct Passes {
    depth: DepthFormat,
    is_jittered: bool,
    gbuffer: MeshPass,
    rows: FullscreenPass,
    columns: FullscreenPass,
    shade: MeshPass,
}

/// Maps for one size of picture, which materials use one after the other.
#[derive(Debug)]
pub(crate) struct Maps {
    /// Light that enters; in the end the exitance.
    entered: Surface2d,
    /// Light blurred along rows.
    between: Surface2d,
    /// Light transmitted from behind and the terms so far, by turns; the second where there are several terms.
    sums: Vec<Surface2d>,
    depth: Surface2d,
}

/// Blocks and bind groups of one material.
#[derive(Debug)]
struct Bound {
    passes: Arc<Passes>,
    maps: Arc<Maps>,
    domain: Tracked<Buffer>,
    upsampling: Tracked<Buffer>,
    gbuffer: [BindGroup; 2],
    /// Along rows and along columns, for each term.
    terms: Vec<[BindGroup; 2]>,
    shade: BindGroup,
    /// Area of the maps in the last frame.
    area: MapArea,
    /// What maps hold where nothing is seen.
    far: Color,
}

/// Pixels of the picture to a side of a texel of the maps, when a mm covers `pixels_per_mm`: the innermost tap is a texel away.
pub(crate) fn divisor(material: &KernelMaterial, pixels_per_mm: f32) -> f32 {
    area::divisor_of(material.narrowest_mm() * pixels_per_mm, 4.0)
}

impl Maps {
    /// Bytes on the device of maps of so many texels.
    pub(crate) fn bytes_of(size: [u32; 2], has_several: bool, options: &RuntimeOptions) -> u64 {
        let maps = if has_several { 4 } else { 3 };
        maps * TextureSpec::target("", size, HALF).bytes()
            + TextureSpec::attachment("", size, options.depth.format).bytes()
    }

    pub(crate) fn new(gpu: &Gpu, plan: &Plan, options: &RuntimeOptions, has_several: bool) -> Result<Self> {
        let size = plan.blur_size;
        let map = |label| gpu.texture(&TextureSpec::target(label, size, gpu.target_texture_format()));
        let mut sums = vec![map("transmitted light, or sums of terms")?];
        if has_several {
            sums.push(map("sums of terms")?);
        }
        Ok(Self {
            entered: map("light that enters, or exitance")?,
            between: map("light blurred along rows")?,
            sums,
            depth: gpu.texture(&TextureSpec::attachment("map depth", size, options.depth.format))?,
        })
    }

    /// Sums before a term.
    fn sums_before(&self, term: usize) -> &Surface2d {
        &self.sums[term % self.sums.len()]
    }
}

impl Passes {
    pub(crate) fn new(gpu: &Gpu, options: &RuntimeOptions) -> Result<Self> {
        let map = gpu.target_texture_format();
        Ok(Self {
            depth: options.depth,
            is_jittered: options.jittered_taps,
            gbuffer: MeshPass::lit(gpu, kernel::KERNEL_GBUFFER.only(), &[map; 2], options)?,
            rows: FullscreenPass::new(gpu, kernel::BLUR_KERNEL.only(), &[map])?,
            columns: FullscreenPass::new(gpu, kernel::SUM_KERNEL.only(), &[map])?,
            shade: MeshPass::picture(gpu, kernel::SHADE_KERNEL.only(), options)?,
        })
    }

    /// Binds a material to the maps of a frame.
    pub(crate) fn bind(
        self: &Arc<Self>,
        gpu: &Gpu,
        material: &KernelMaterial,
        common: &Common,
        lights: &TranslucentShadowMaps,
        maps: &Arc<Maps>,
    ) -> Result<Box<dyn Bindings>> {
        let texture = BindingResource::TextureView;
        let domain = gpu.uniform(Purpose::Frame, "screen", &ScreenDomain::default());
        let upsampling = gpu.uniform(Purpose::Frame, "upsampling", &Upsampling::default());
        let of_scene = [common.scene.as_entire_binding(), texture(lights.views()[0])];
        let of_gbuffer = [material.profile(), material.tail(), texture(lights.views()[1])];
        let of_shade = [material.profile(), texture(&maps.entered.view), upsampling.as_entire_binding()];
        let terms = (0..material.terms()).map(|term| {
            let ([rows, columns], screen) = (material.term(term), domain.as_entire_binding());
            let (between, before) = (texture(&maps.between.view), texture(&maps.sums_before(term).view));
            Ok([
                self.rows.bind(gpu, 0, &[rows, screen.clone(), texture(&maps.entered.view)])?,
                self.columns.bind(gpu, 0, &[columns, screen, between, before])?,
            ])
        });
        Ok(Box::new(Bound {
            terms: terms.collect::<Result<_>>()?,
            gbuffer: [self.gbuffer.bind(gpu, 0, &of_scene)?, self.gbuffer.bind(gpu, 1, &of_gbuffer)?],
            shade: self.shade.bind(gpu, 1, &of_shade)?,
            far: gpu.clear_colour(Color { r: 0.0, g: 0.0, b: 0.0, a: FAR_MM }),
            area: MapArea::default(),
            maps: maps.clone(),
            domain,
            upsampling,
            passes: self.clone(),
        }))
    }
}

impl Bindings for Bound {
    /// Tells the passes how large a mm is on the screen.
    fn update(&mut self, gpu: &Gpu, group: &Group<'_>) {
        let (view, plan) = (&group.input.view, group.plan);
        self.area = MapArea::over(view, &group.bounds, plan.size, plan.blur_size, plan.divisor);
        // A kernel is in mm.
        let domain = group.screen(&self.area, 1.0, self.passes.is_jittered);
        gpu.queue.write_buffer(&self.domain, 0, bytemuck::bytes_of(&domain));
        gpu.queue.write_buffer(&self.upsampling, 0, bytemuck::bytes_of(&group.upsampling(&self.area)));
    }

    fn record(&self, encoder: &mut CommandEncoder, group: &Group<'_>, shared: SharedGroups<'_>, lap: Lap<'_>) {
        let maps = &*self.maps;
        let colours = [&maps.entered, maps.sums_before(0)].map(|map| cleared(&map.view, self.far));
        let attachments = Attachments {
            colours: &colours,
            depth: &maps.depth.view,
            depth_ops: self.passes.depth.own(),
            viewport: Some(self.area.viewport()),
        };
        let [scene, profile] = &self.gbuffer;
        let Passes { gbuffer, rows, columns, .. } = &*self.passes;
        gbuffer.record(encoder, &attachments, [scene, profile], shared, group.draws());
        lap(gbuffer.name(), encoder);
        let all = Rows::all(self.area.size);
        for (term, [along_rows, along_columns]) in self.terms.iter().enumerate() {
            rows.record(encoder, &[&maps.between.view], &[along_rows], all);
            lap(rows.name(), encoder);
            // Light that enters is not needed any more once the last term is blurred along rows.
            let is_last = term + 1 == self.terms.len();
            let to = if is_last { &maps.entered } else { maps.sums_before(term + 1) };
            columns.record(encoder, &[&to.view], &[along_columns], all);
            lap(columns.name(), encoder);
        }
    }

    fn shade(&self) -> (&MeshPass, &BindGroup) {
        (&self.passes.shade, &self.shade)
    }
}
