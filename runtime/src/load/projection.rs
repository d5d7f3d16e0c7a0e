//! Projection: layers over a patch, drawn from the planes of a file that are on the device anyway.

use subsurf_shaders::MaterialLayout;
use subsurf_shaders::passes::{Choice, table as passes};
use subsurf_shaders::separable::ProfileSums;
use wgpu::{
    BindingResource, CommandEncoder, CommandEncoderDescriptor, TextureFormat, TextureView, TextureViewDescriptor,
    TextureViewDimension,
};

use crate::asset::{BssrdfPlanes, PatchLayers, SeparableMaterial};
use crate::error::Result;
use crate::gpu::{Fill, FullscreenPass, Gpu, Rows, Surface2d, TextureSpec, layer_of};
use crate::technique::{PatchLight, SeparableRenderer};

/// Layers that are being drawn: every pass draws to targets of its own, which are copied into the layers.
pub(super) struct Projection<'a> {
    gpu: &'a Gpu,
    encoder: CommandEncoder,
    to: &'a PatchLayers,
    /// As many layers as `to`, without mipmap levels.
    drawn: Surface2d,
    targets: Vec<TextureView>,
}

/// Table of sums over profiles, and what it has to be filled with.
pub(super) fn table(gpu: &Gpu, sums: &ProfileSums) -> Result<(Surface2d, Fill<'static>)> {
    let texels = sums.texels();
    let table = gpu.texture(&TextureSpec::array("sums over profiles", texels.len(), TextureFormat::Rgba32Float))?;
    let fill = Fill::whole(&table.texture, bytemuck::cast_slice(&texels).to_vec());
    Ok((table, fill))
}

/// Pass of one or two sums over the profiles of a layout.
pub(super) fn sums_pass(gpu: &Gpu, layout: MaterialLayout, count: usize) -> Result<FullscreenPass> {
    let variant = passes::PROFILE_SUMS.with(Choice::Material(layout));
    FullscreenPass::new(gpu, variant, &vec![gpu.target_texture_format(); count])
}

/// Pass of the next mipmap level of so many layers.
pub(super) fn levels_pass(gpu: &Gpu, layers: usize) -> Result<FullscreenPass> {
    FullscreenPass::new(gpu, passes::PATCH_REDUCE.only(), &vec![gpu.target_texture_format(); layers])
}

impl<'a> Projection<'a> {
    /// Makes targets for layers.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the device has no room for them.
    pub(super) fn new(gpu: &'a Gpu, to: &'a PatchLayers) -> Result<Self> {
        let size = [to.surface.texture.width(), to.surface.texture.height()];
        let target = TextureSpec::target("projected layers", size, gpu.target_texture_format());
        let layered = TextureSpec::layered(target.label, size, to.count, target.format);
        let drawn = gpu.texture(&TextureSpec { usage: target.usage, ..layered })?;
        let targets = (0..to.count).map(|layer| layer_of(&drawn, layer)).collect();
        let encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        Ok(Self { gpu, encoder, to, drawn, targets })
    }

    /// Draws one or two sums over profiles into the first layers.
    pub(super) fn sums(&mut self, planes: &BssrdfPlanes, table: &Surface2d, count: usize) -> Result<()> {
        let pass = sums_pass(self.gpu, planes.layout(), count)?;
        let of_planes = pass.bind(self.gpu, 0, &planes.resources())?;
        let of_sums = pass.bind(self.gpu, 1, &[BindingResource::TextureView(&table.view)])?;
        let targets: Vec<&TextureView> = self.targets.iter().take(count).collect();
        let rows = Rows::all(self.size(0));
        pass.record(&mut self.encoder, &targets, &[&of_planes, &of_sums], rows);
        (0..self.to.count).take(count).for_each(|layer| self.copy(layer, 0));
        Ok(())
    }

    /// Draws the exitance by a basis under an irradiance of 1 into a layer.
    pub(super) fn albedo(&mut self, basis: &SeparableMaterial, layer: u32) -> Result<()> {
        let renderer = SeparableRenderer::new(self.gpu, basis.terms())?;
        let light = PatchLight::uniform(self.gpu)?;
        let patch = renderer.bind(self.gpu, basis, &light)?;
        let size = self.size(0);
        let exitance = renderer.record(&mut self.encoder, &patch);
        self.gpu.copy_target(&mut self.encoder, (exitance.texture(), 0), (&self.to.surface.texture, layer, 0), size);
        Ok(())
    }

    /// Draws all mipmap levels but the finest, each from the one before.
    pub(super) fn levels(&mut self) -> Result<()> {
        let pass = levels_pass(self.gpu, self.targets.len())?;
        for level in 1..self.to.surface.texture.mip_level_count() {
            let finer = self.to.surface.texture.create_view(&TextureViewDescriptor {
                dimension: Some(TextureViewDimension::D2Array),
                base_mip_level: level - 1,
                mip_level_count: Some(1),
                ..Default::default()
            });
            let group = pass.bind(self.gpu, 0, &[BindingResource::TextureView(&finer)])?;
            let targets: Vec<&TextureView> = self.targets.iter().collect();
            let rows = Rows::all(self.size(level));
            pass.record(&mut self.encoder, &targets, &[&group], rows);
            (0..self.to.count).for_each(|layer| self.copy(layer, level));
        }
        Ok(())
    }

    /// Hands everything to the device, without waiting for it.
    pub(super) fn submit(self) -> Result<()> {
        self.gpu.checked(|| {
            self.gpu.queue.submit([self.encoder.finish()]);
        })
    }

    /// Width and height of a level.
    fn size(&self, level: u32) -> [u32; 2] {
        [self.drawn.texture.width(), self.drawn.texture.height()].map(|side| (side >> level).max(1))
    }

    /// Copies what was drawn for a layer to a level of it.
    fn copy(&mut self, layer: u32, level: u32) {
        let size = self.size(level);
        let to = (&*self.to.surface.texture, layer, level);
        self.gpu.copy_target(&mut self.encoder, (&self.drawn.texture, layer), to, size);
    }
}
