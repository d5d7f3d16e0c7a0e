//! Projection: layers over a patch, drawn from the planes of a file that are on the device anyway.

use std::sync::Arc;

use subsurf_shaders::MaterialLayout;
use subsurf_shaders::passes::{Choice, table as passes};
use subsurf_shaders::separable::ProfileSums;
use wgpu::{BindingResource, CommandEncoder, CommandEncoderDescriptor, TextureFormat, TextureView};

use crate::asset::{BssrdfPlanes, PatchLayers, SeparableMaterial};
use crate::error::Result;
use crate::gpu::{Fill, FullscreenPass, Gpu, Rows, Surface2d, TextureSpec, layers_of};
use crate::technique::{CascadeMaps, Maps, PatchCascade};

/// Passes over a patch, being recorded. They draw to targets of their own, which are copied into the layers.
pub(super) struct Projection<'a> {
    gpu: &'a Gpu,
    encoder: CommandEncoder,
}

/// Table of sums over profiles, and what it has to be filled with.
pub(super) fn table(gpu: &Gpu, sums: &ProfileSums) -> Result<(Surface2d, Fill<'static>)> {
    let mut texels = sums.texels();
    // Whole rows: the device would clear a texture that is filled in parts.
    let spec = TextureSpec::array("sums over profiles", texels.len(), TextureFormat::Rgba32Float);
    texels.resize(spec.size.map(|side| side as usize).iter().product(), [0.0; 4]);
    let table = gpu.texture(&spec)?;
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
    /// Projection without a pass.
    pub(super) fn new(gpu: &'a Gpu) -> Self {
        let encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
        Self { gpu, encoder }
    }

    /// Draws the coefficients of a basis into its layers, and their exitance under an irradiance of 1 into a layer that may be of
    /// another material.
    pub(super) fn basis(
        &mut self,
        (planes, table): (&BssrdfPlanes, &Surface2d),
        basis: &SeparableMaterial,
        (albedo, layer): (&PatchLayers, u32),
    ) -> Result<()> {
        let (gpu, size) = (self.gpu, [planes.header().width, planes.header().height]);
        let passes = PatchCascade::new(gpu, basis.terms())?;
        let maps = Arc::new(CascadeMaps::new(gpu, size, basis.terms())?);
        let cascade = passes.bind(gpu, None, basis, &maps)?;
        // c_l, which are the maps c_l E as well.
        self.sums((planes, table), &maps.irradiance().layers)?;
        self.copy(maps.irradiance(), (&basis.layers, 0, 0), size);
        let exitance = &maps.sums().layers[0];
        passes.record(&mut self.encoder, size, None, &cascade, exitance);
        self.gpu.copy_target(&mut self.encoder, exitance.texture(), (&albedo.surface.texture, layer, 0), size, 1);
        Ok(())
    }

    /// Draws sums over profiles into the layers.
    pub(super) fn layers(&mut self, of: (&BssrdfPlanes, &Surface2d), to: &PatchLayers) -> Result<()> {
        let size = [of.0.header().width, of.0.header().height];
        let drawn = Maps::new(self.gpu, "projected layers", size, to.count as usize)?;
        self.sums(of, &drawn.layers)?;
        self.copy(&drawn, (to, 0, 0), size);
        Ok(())
    }

    /// Draws all mipmap levels of layers but the finest, each from the one before.
    pub(super) fn levels(&mut self, of: &PatchLayers) -> Result<()> {
        let texture = &of.surface.texture;
        let size = |level: u32| [texture.width(), texture.height()].map(|side| (side >> level).max(1));
        let pass = levels_pass(self.gpu, of.count as usize)?;
        let drawn = Maps::new(self.gpu, "levels of layers", size(1), of.count as usize)?;
        for level in 1..texture.mip_level_count() {
            let finer = layers_of(&of.surface, of.count, level - 1);
            let group = pass.bind(self.gpu, 0, &[BindingResource::TextureView(&finer)])?;
            let targets: Vec<&TextureView> = drawn.layers.iter().collect();
            pass.record(&mut self.encoder, &targets, &[&group], Rows::all(size(level)));
            self.copy(&drawn, (of, 0, level), size(level));
        }
        Ok(())
    }

    /// Hands everything to the device, without waiting for it.
    pub(super) fn submit(self) -> Result<()> {
        self.gpu.checked(|| {
            self.gpu.queue.submit([self.encoder.finish()]);
        })
    }

    /// Draws one or two sums over profiles to targets over the patch.
    fn sums(&mut self, (planes, table): (&BssrdfPlanes, &Surface2d), targets: &[TextureView]) -> Result<()> {
        let pass = sums_pass(self.gpu, planes.layout(), targets.len())?;
        let of_planes = pass.bind(self.gpu, 0, &planes.resources())?;
        let of_sums = pass.bind(self.gpu, 1, &[BindingResource::TextureView(&table.view)])?;
        let rows = Rows::all([planes.header().width, planes.header().height]);
        let targets: Vec<&TextureView> = targets.iter().collect();
        pass.record(&mut self.encoder, &targets, &[&of_planes, &of_sums], rows);
        Ok(())
    }

    /// Copies the first `size` texels of maps to a level, from a layer on.
    fn copy(&mut self, from: &Maps, (to, layer, level): (&PatchLayers, u32, u32), size: [u32; 2]) {
        let (from, layers) = (&from.surface.texture, from.surface.texture.depth_or_array_layers());
        self.gpu.copy_target(&mut self.encoder, from, (&to.surface.texture, layer, level), size, layers);
    }
}
