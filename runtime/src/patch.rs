//! Draws a flat patch: irradiance in, exitance and a picture out.

use subsurf_shaders::{Storage, source, uniform};
use wgpu::{BindingResource, TextureFormat, TextureView};

use crate::context::Gpu;
use crate::error::{Error, Result};
use crate::material::{Material, slots};
use crate::pass::{CoverPass, Rows};
use crate::resource::{Slot, Surface2d, TextureSpec};

/// Renders flat patches of one storage; its pipelines are made once.
#[derive(Debug)]
pub struct PatchRenderer {
    storage: Storage,
    gather: CoverPass,
    present: CoverPass,
}

/// Irradiance on the patch, on the device.
#[derive(Debug)]
pub struct PatchLight(Surface2d);

/// Exitance of a region of the patch, on the device, as half floats or their bits.
#[derive(Debug)]
pub struct Exitance {
    surface: Surface2d,
    size: [u32; 2],
}

/// Pixels of a patch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Region {
    /// Column and row of the first pixel.
    pub origin: [u32; 2],
    /// Pixels in x and y.
    pub size: [u32; 2],
}

impl PatchRenderer {
    /// Compiles the passes for a storage.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the driver refuses them.
    pub fn new(gpu: &Gpu, storage: Storage) -> Result<Self> {
        let gather_groups = [slots(storage), &[Slot::Uniform, Slot::Float]];
        let present_groups: [&[Slot]; 1] = [&[Slot::Uniform, Slot::Kept]];
        Ok(Self {
            storage,
            gather: CoverPass::new(gpu, source::gather(storage), "gather", &gather_groups, &[gpu.kept()])?,
            present: CoverPass::new(gpu, source::PRESENT, "present", &present_groups, &[TextureFormat::Rgba8Unorm])?,
        })
    }

    /// Exitance Σ Rd(x_i, x_o) E(x_i) pitch² of a region.
    ///
    /// # Errors
    /// [`crate::Error::Device`].
    pub fn gather(&self, gpu: &Gpu, material: &Material, light: &PatchLight, region: Region) -> Result<Exitance> {
        material.expect(self.storage)?;
        light.expect([material.header().width, material.header().height])?;
        let spec = TextureSpec::target("exitance", region.size, gpu.kept());
        let surface = gpu.texture(&spec)?;
        let view = gpu.uniform("view", &uniform::View { origin: region.origin, pad: [0; 2] });
        let of_material = self.gather.bind(gpu, 0, &material.resources())?;
        let of_view = [view.as_entire_binding(), BindingResource::TextureView(&light.0.view)];
        let of_view = self.gather.bind(gpu, 1, &of_view)?;
        let d = 2 * u64::from(material.header().window_radius) + 1;
        for rows in Rows::bands(region.size, d * d * u64::from(region.size[0])) {
            self.gather.draw(gpu, &surface.view, &[&of_material, &of_view], rows)?;
        }
        Ok(Exitance::new(surface, region.size))
    }

    /// The picture of an exitance: `size` pixels of 8-bit sRGB, tone-mapped after multiplication with `exposure`.
    ///
    /// # Errors
    /// [`crate::Error::Device`].
    pub fn picture(&self, gpu: &Gpu, exitance: &Exitance, size: [u32; 2], exposure: f32) -> Result<Vec<[u8; 3]>> {
        let target = gpu.texture(&TextureSpec::target("picture", size, TextureFormat::Rgba8Unorm))?;
        let frame = uniform::Frame { size, texels: exitance.size, exposure, pad: [0.0; 3] };
        let frame = gpu.uniform("frame", &frame);
        let resources = [frame.as_entire_binding(), BindingResource::TextureView(&exitance.surface.view)];
        let group = self.present.bind(gpu, 0, &resources)?;
        self.present.draw(gpu, &target.view, &[&group], Rows::all(size))?;
        let texels: Vec<[u8; 4]> = gpu.read(&target.texture)?;
        Ok(texels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect())
    }
}

impl PatchLight {
    /// Uploads irradiance that has entered the material, one linear rgb value per pixel of a patch of `size`, row by row.
    ///
    /// # Errors
    /// [`crate::Error::Unsupported`] if the patch is too large for a texture.
    pub fn upload(gpu: &Gpu, size: [u32; 2], irradiance: &[[f32; 3]]) -> Result<Self> {
        let texels: Vec<[f32; 4]> = irradiance.iter().map(|[r, g, b]| [*r, *g, *b, 1.0]).collect();
        let spec = TextureSpec::table("patch irradiance", size, TextureFormat::Rgba32Float);
        Ok(Self(gpu.filled(&spec, bytemuck::cast_slice(&texels))?))
    }

    pub(crate) fn view(&self) -> &TextureView {
        &self.0.view
    }

    /// Refuses light of another size than the patch: texels beyond it are not there.
    pub(crate) fn expect(&self, size: [u32; 2]) -> Result<()> {
        let have = [self.0.texture.width(), self.0.texture.height()];
        if have == size {
            return Ok(());
        }
        Err(Error::Device(format!("light for a patch of {have:?} pixels, the material has {size:?}")))
    }
}

impl Exitance {
    pub(crate) fn new(surface: Surface2d, size: [u32; 2]) -> Self {
        Self { surface, size }
    }

    pub(crate) fn view(&self) -> &TextureView {
        &self.surface.view
    }

    /// Reads it back, linear rgb, row by row.
    ///
    /// # Errors
    /// [`crate::Error::Device`].
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>> {
        gpu.read_rgb(&self.surface.texture)
    }
}
