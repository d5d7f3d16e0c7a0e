//! Flat patches with one kernel for all pixels.

use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_shaders::passes::table;
use subsurf_shaders::uniform::{Kernel, MAX_KERNEL};
use wgpu::{BindGroup, BindingResource, Buffer, CommandEncoderDescriptor, TextureView};

use super::surface::{Exitance, PatchLight, nearest};
use crate::error::{Error, Result};
use crate::gpu::{FullscreenPass, Gpu, HALF, Purpose, Rows, Surface2d, TextureSpec};

/// Pipeline of flat patches with one kernel for all pixels: what heterogeneity is compared with.
#[derive(Debug)]
pub struct HomogeneousRenderer {
    pass: FullscreenPass,
}

/// Patch under a light and with one kernel, ready to be drawn any number of times.
#[derive(Debug)]
pub struct HomogeneousPatch {
    between: Surface2d,
    groups: [BindGroup; 2],
    exitance: Exitance,
    size: [u32; 2],
}

impl HomogeneousRenderer {
    /// Compiles the pass.
    ///
    /// # Errors
    /// [`Error::Device`] if the driver refuses it; [`Error::NoHalfFloats`].
    pub fn new(gpu: &Gpu) -> Result<Self> {
        gpu.expect_half_targets("blurs on flat patches")?;
        Ok(Self { pass: FullscreenPass::new(gpu, table::HOMOGENEOUS.only(), &[HALF])? })
    }

    /// Makes room for a patch; `kernel` as [`subsurf_shaders::mean_kernel`] has it.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if it is too large, or the kernel.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        header: &BssrdfHeader,
        kernel: &[[f32; 3]],
        light: &PatchLight,
    ) -> Result<HomogeneousPatch> {
        let size = [header.width, header.height];
        light.expect(size)?;
        let nearest = nearest(gpu, header.addressing);
        if kernel.len() > MAX_KERNEL {
            let (need, have) = (kernel.len() as u64, MAX_KERNEL as u64);
            return Err(Error::Unsupported { what: "kernels", need, have });
        }
        let [rows, columns] = Kernel::new(kernel).map(|block| gpu.uniform(Purpose::Frame, "kernel", &block));
        let between = gpu.texture(&TextureSpec::target("between rows and columns", size, HALF))?;
        let bind = |block: &Buffer, image: &TextureView| {
            let image = BindingResource::TextureView(image);
            self.pass.bind(gpu, 0, &[block.as_entire_binding(), BindingResource::Sampler(&nearest), image])
        };
        let groups = [bind(&rows, light.view())?, bind(&columns, &between.view)?];
        let surface = gpu.texture(&TextureSpec::target("exitance", size, HALF))?;
        Ok(HomogeneousPatch { between, groups, exitance: Exitance::new(surface, size), size })
    }

    /// Draws the exitance of the whole patch.
    ///
    /// # Errors
    /// [`Error::Device`] if the device is lost.
    pub fn draw<'a>(&self, gpu: &Gpu, patch: &'a HomogeneousPatch) -> Result<&'a Exitance> {
        let all = Rows::all(patch.size);
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            self.pass.record(&mut encoder, &[&patch.between.view], &[&patch.groups[0]], all);
            self.pass.record(&mut encoder, &[patch.exitance.view()], &[&patch.groups[1]], all);
            gpu.queue.submit([encoder.finish()]);
        })?;
        Ok(&patch.exitance)
    }
}
