//! Draws a flat patch from its factors: weighted irradiance maps, shared Gaussians, one sum.

use half::f16;
use subsurf_decoder::bssrdf::Header;
use subsurf_shaders::separable::Factors;
use subsurf_shaders::{source, uniform};
use wgpu::{
    BindingResource, Buffer, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension,
};

use crate::context::Gpu;
use crate::error::Result;
use crate::ledger::Tracked;
use crate::material::layers_of;
use crate::pass::{CoverPass, Rows};
use crate::patch::{Exitance, PatchLight};
use crate::resource::{Slot, Surface2d, TextureSpec};

/// Renders flat patches of factorised materials; its pipelines are made once.
#[derive(Debug)]
pub struct SeparableRenderer {
    weigh: CoverPass,
    blur: CoverPass,
    combine: CoverPass,
}

/// Factors on the device, and the maps that they are used on.
#[derive(Debug)]
pub struct SeparableMaterial {
    header: Header,
    /// c_l, a layer each.
    coefficients: Surface2d,
    /// Which layer each l has.
    terms: Vec<Tracked<Buffer>>,
    /// Along rows and along columns, for each a.
    blurs: Vec<[Tracked<Buffer>; 2]>,
    combine: Tracked<Buffer>,
    /// c_l E of one l, and the same blurred along rows.
    weighted: Surface2d,
    across: Surface2d,
    /// G_a * (c_l E), a layer each, a fastest.
    blurred: Surface2d,
}

impl SeparableMaterial {
    /// Uploads factors as half floats.
    ///
    /// # Errors
    /// [`crate::Error::Unsupported`] if the device takes no texture of that size.
    pub fn upload(gpu: &Gpu, factors: &Factors) -> Result<Self> {
        let header = factors.header;
        let size = [header.width, header.height];
        let layers = u32::try_from(factors.detail.terms).unwrap_or(u32::MAX);
        let maps = u32::try_from(factors.detail.terms * factors.detail.gaussians).unwrap_or(u32::MAX);
        let format = TextureFormat::Rgba16Float;
        let coefficients = gpu.texture(&TextureSpec::layered("factors", size, layers, format))?;
        for (l, layer) in (0..factors.detail.terms).zip(0..) {
            let texels = factors.coefficients_of(l).iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]);
            let texels: Vec<u16> = texels.map(|value| f16::from_f32(value).to_bits()).collect();
            gpu.checked(|| gpu.fill(&coefficients.texture, layer, bytemuck::cast_slice(&texels)))?;
        }
        let blur = |sigma, axis| gpu.uniform("blur", &uniform::Blur::new(&header, sigma, axis));
        let target = |label| gpu.texture(&TextureSpec::target(label, size, format));
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        Ok(Self {
            header,
            coefficients,
            terms: (0..layers).map(|layer| gpu.uniform("term", &uniform::Term { layer, pad: [0; 3] })).collect(),
            blurs: factors.sigmas.iter().map(|sigma| [[1, 0], [0, 1]].map(|axis| blur(*sigma, axis))).collect(),
            combine: gpu.uniform("combine", &uniform::Combine::new(factors)),
            weighted: target("weighted irradiance")?,
            across: target("irradiance blurred along rows")?,
            blurred: gpu.texture(&TextureSpec { usage, ..TextureSpec::layered("blurred", size, maps, format) })?,
        })
    }
}

impl SeparableMaterial {
    /// Bytes on the device, the maps of a frame included.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        let surfaces = [&self.coefficients, &self.weighted, &self.across, &self.blurred];
        let buffers = self.terms.iter().chain(self.blurs.iter().flatten()).chain([&self.combine]);
        surfaces.iter().map(|surface| surface.texture.bytes()).sum::<u64>() + buffers.map(Tracked::bytes).sum::<u64>()
    }
}

impl SeparableRenderer {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the driver refuses them.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let pass = |text, entry, slots: &[Slot]| CoverPass::new(gpu, text, entry, &[slots], TextureFormat::Rgba16Float);
        Ok(Self {
            weigh: pass(source::WEIGH, "weigh", &[Slot::FloatLayers, Slot::Float, Slot::Uniform])?,
            blur: pass(source::BLUR, "blur", &[Slot::Uniform, Slot::Float])?,
            combine: pass(source::COMBINE, "combine", &[Slot::Uniform, Slot::FloatLayers, Slot::FloatLayers])?,
        })
    }

    /// Exitance of the whole patch.
    ///
    /// # Errors
    /// [`crate::Error::Device`].
    pub fn exitance(&self, gpu: &Gpu, material: &SeparableMaterial, light: &PatchLight) -> Result<Exitance> {
        let size = [material.header.width, material.header.height];
        let all = Rows { width: size[0], first: 0, count: size[1] };
        let coefficients = layers_of(&material.coefficients);
        let texture = BindingResource::TextureView;
        let mut map = 0;
        for term in &material.terms {
            let resources = [texture(&coefficients), texture(light.view()), term.as_entire_binding()];
            let group = self.weigh.bind(gpu, 0, &resources)?;
            self.weigh.draw(gpu, &material.weighted.view, &[&group], all)?;
            for [rows, columns] in &material.blurs {
                self.along(gpu, rows, &material.weighted.view, &material.across.view, all)?;
                self.along(gpu, columns, &material.across.view, &layer_of(&material.blurred, map), all)?;
                map += 1;
            }
        }
        let surface = gpu.texture(&TextureSpec::target("exitance", size, TextureFormat::Rgba16Float))?;
        let blurred = layers_of(&material.blurred);
        let resources = [material.combine.as_entire_binding(), texture(&coefficients), texture(&blurred)];
        let group = self.combine.bind(gpu, 0, &resources)?;
        self.combine.draw(gpu, &surface.view, &[&group], all)?;
        Ok(Exitance::new(surface, size))
    }

    /// One blur along one axis.
    fn along(&self, gpu: &Gpu, settings: &Buffer, from: &TextureView, to: &TextureView, all: Rows) -> Result<()> {
        let resources = [settings.as_entire_binding(), BindingResource::TextureView(from)];
        let group = self.blur.bind(gpu, 0, &resources)?;
        self.blur.draw(gpu, to, &[&group], all)
    }
}

/// One layer, to be drawn to.
fn layer_of(surface: &Surface2d, layer: u32) -> TextureView {
    surface.texture.create_view(&TextureViewDescriptor {
        dimension: Some(TextureViewDimension::D2),
        base_array_layer: layer,
        array_layer_count: Some(1),
        ..Default::default()
    })
}
