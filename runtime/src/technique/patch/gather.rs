//! Gather on flat patches: the reference.

use subsurf_shaders::passes::{Choice, table};
use subsurf_shaders::{MaterialLayout, uniform};
use wgpu::{BindingResource, TextureFormat};

use super::surface::{Exitance, PatchLight, Region};
use crate::asset::BssrdfPlanes;
use crate::error::Result;
use crate::gpu::{FullscreenPass, Gpu, Purpose, Rows, TextureSpec};

/// Pipelines of the gather on flat patches of one layout; made once.
#[derive(Debug)]
pub struct PatchRenderer {
    layout: MaterialLayout,
    gather: FullscreenPass,
    present: FullscreenPass,
}

impl PatchRenderer {
    /// Compiles the passes for a layout.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the driver refuses them.
    pub fn new(gpu: &Gpu, layout: MaterialLayout) -> Result<Self> {
        let gather = table::GATHER.with(Choice::Material(layout));
        Ok(Self {
            layout,
            gather: FullscreenPass::new(gpu, gather, &[gpu.target_texture_format()])?,
            present: FullscreenPass::new(gpu, table::PRESENT.only(), &[TextureFormat::Rgba8Unorm])?,
        })
    }

    /// Exitance Σ Rd(x_i, x_o) E(x_i) pitch² of a region, in the unit of the irradiance.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if material or light are for another layout or size, or the device is lost.
    pub fn gather(&self, gpu: &Gpu, material: &BssrdfPlanes, light: &PatchLight, region: Region) -> Result<Exitance> {
        material.expect(self.layout)?;
        light.expect([material.header().width, material.header().height])?;
        let spec = TextureSpec::target("exitance", region.size, gpu.target_texture_format());
        let surface = gpu.texture(&spec)?;
        let block = gpu.uniform(Purpose::Frame, "region", &uniform::PatchRegion { origin: region.origin, pad: [0; 2] });
        let of_material = self.gather.bind(gpu, 0, &material.resources())?;
        let of_region = [block.as_entire_binding(), BindingResource::TextureView(light.view())];
        let of_region = self.gather.bind(gpu, 1, &of_region)?;
        let d = 2 * u64::from(material.header().window_radius) + 1;
        for rows in Rows::bands(region.size, d * d * u64::from(region.size[0])) {
            self.gather.draw(gpu, &surface.view, &[&of_material, &of_region], rows)?;
        }
        Ok(Exitance::new(surface, region.size))
    }

    /// Picture of an exitance: `size` pixels of 8-bit sRGB, row by row, tone-mapped after multiplication with `exposure`.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device is lost.
    pub fn picture(&self, gpu: &Gpu, exitance: &Exitance, size: [u32; 2], exposure: f32) -> Result<Vec<[u8; 3]>> {
        let target = gpu.texture(&TextureSpec {
            purpose: Purpose::Other,
            ..TextureSpec::target("picture", size, TextureFormat::Rgba8Unorm)
        })?;
        let frame = uniform::Frame { size, texels: exitance.size, exposure, pad: [0.0; 3] };
        let frame = gpu.uniform(Purpose::Frame, "frame", &frame);
        let resources = [frame.as_entire_binding(), BindingResource::TextureView(&exitance.surface.view)];
        let group = self.present.bind(gpu, 0, &resources)?;
        self.present.draw(gpu, &target.view, &[&group], Rows::all(size))?;
        let texels: Vec<[u8; 4]> = gpu.read(&target.texture)?;
        Ok(texels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect())
    }
}
