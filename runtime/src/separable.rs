//! Draws a flat patch from its factors: weighted irradiance maps, shared Gaussians, one sum.

use half::f16;
use subsurf_decoder::bssrdf::Header;
use subsurf_shaders::separable::Factors;
use subsurf_shaders::{source, uniform};
use wgpu::{BindingResource, TextureFormat, TextureUsages, TextureView, TextureViewDescriptor, TextureViewDimension};

use crate::context::Gpu;
use crate::error::Result;
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
    terms: u32,
    sigmas: Vec<f32>,
    /// c_l, a layer each.
    coefficients: Surface2d,
    combine: uniform::Combine,
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
        let terms = u32::try_from(factors.detail.terms).unwrap_or(u32::MAX);
        let maps = u32::try_from(factors.detail.terms * factors.detail.gaussians).unwrap_or(u32::MAX);
        let format = TextureFormat::Rgba16Float;
        let coefficients = gpu.texture(&TextureSpec::layered("factors", size, terms, format))?;
        for (l, layer) in (0..factors.detail.terms).zip(0..) {
            let texels = factors.coefficients_of(l).iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0]);
            let texels: Vec<u16> = texels.map(|value| f16::from_f32(value).to_bits()).collect();
            gpu.checked(|| gpu.fill(&coefficients.texture, layer, bytemuck::cast_slice(&texels)))?;
        }
        let target = |label| gpu.texture(&TextureSpec::target(label, size, format));
        let usage = TextureUsages::RENDER_ATTACHMENT | TextureUsages::TEXTURE_BINDING;
        Ok(Self {
            header,
            terms,
            sigmas: factors.sigmas.clone(),
            coefficients,
            combine: uniform::Combine::new(factors),
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
        [&self.coefficients, &self.weighted, &self.across, &self.blurred].iter().map(|s| s.texture.bytes()).sum()
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
        for l in 0..material.terms {
            let term = gpu.uniform("term", &uniform::Term { layer: l, pad: [0; 3] });
            let resources = [texture(&coefficients), texture(light.view()), term.as_entire_binding()];
            let group = self.weigh.bind(gpu, 0, &resources)?;
            self.weigh.draw(gpu, &material.weighted.view, &[&group], all)?;
            for (&sigma, a) in material.sigmas.iter().zip(0..) {
                self.along(gpu, material, sigma, [1, 0], &material.weighted.view, &material.across.view)?;
                let map = l * u32::try_from(material.sigmas.len()).unwrap_or(0) + a;
                let target = layer_of(&material.blurred, map);
                self.along(gpu, material, sigma, [0, 1], &material.across.view, &target)?;
            }
        }
        let surface = gpu.texture(&TextureSpec::target("exitance", size, TextureFormat::Rgba16Float))?;
        let sum = gpu.uniform("combine", &material.combine);
        let blurred = layers_of(&material.blurred);
        let resources = [sum.as_entire_binding(), texture(&coefficients), texture(&blurred)];
        let group = self.combine.bind(gpu, 0, &resources)?;
        self.combine.draw(gpu, &surface.view, &[&group], all)?;
        Ok(Exitance::new(surface, size))
    }

    /// One blur along one axis.
    fn along(
        &self,
        gpu: &Gpu,
        material: &SeparableMaterial,
        sigma: f32,
        axis: [i32; 2],
        from: &TextureView,
        to: &TextureView,
    ) -> Result<()> {
        let settings = gpu.uniform("blur", &uniform::Blur::new(&material.header, sigma, axis));
        let resources = [settings.as_entire_binding(), BindingResource::TextureView(from)];
        let group = self.blur.bind(gpu, 0, &resources)?;
        let size = [material.header.width, material.header.height];
        self.blur.draw(gpu, to, &[&group], Rows { width: size[0], first: 0, count: size[1] })
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
