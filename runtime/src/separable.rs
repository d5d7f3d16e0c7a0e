//! Draws a flat patch from its factors: a cascade of Gaussians from weighted irradiance to exitance.

use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader};
use subsurf_shaders::source::{self, Domain};
use subsurf_shaders::uniform::{Kernel, MAX_KERNEL};
use wgpu::{
    AddressMode, BindGroup, BindingResource, Buffer, CommandEncoderDescriptor, Sampler, SamplerDescriptor, TextureView,
};

use crate::cascade::{BlurPasses, Cascade, Ends, MAP};
use crate::context::Gpu;
use crate::error::{Error, Result};
use crate::factors::SeparableMaterial;
use crate::pass::{CoverPass, Rows};
use crate::patch::{Exitance, PatchLight};
use crate::resource::{Slot, Surface2d, TextureSpec};

/// Renders flat patches of factorised materials of L terms; its pipelines are made once.
#[derive(Debug)]
pub struct SeparableRenderer {
    terms: usize,
    first: CoverPass,
    blur: BlurPasses,
    last: CoverPass,
}

/// A factorised patch under a light, ready to be drawn any number of times.
#[derive(Debug)]
pub struct SeparablePatch {
    cascade: Cascade,
    first: BindGroup,
    last: BindGroup,
    exitance: Exitance,
}

impl SeparableRenderer {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`Error::Device`] if the driver refuses them; [`Error::NoHalfFloats`].
    pub fn new(gpu: &Gpu, terms: usize) -> Result<Self> {
        gpu.expect_halves("blurs on flat patches")?;
        let of_first = [Slot::Uniform, Slot::Nearest, Slot::FilteredLayers, Slot::Float];
        let of_last = [Slot::Uniform, Slot::Nearest, Slot::FloatLayers, Slot::KeptLayers, Slot::FilteredLayers];
        Ok(Self {
            terms,
            first: CoverPass::new(gpu, source::first_rows(terms), "blur", &[&of_first], &vec![MAP; terms])?,
            blur: BlurPasses::new(gpu, Domain::Patch, terms)?,
            last: CoverPass::new(gpu, source::last_columns(terms), "blur", &[&of_last], &[MAP])?,
        })
    }

    /// Makes room for the maps of a patch.
    ///
    /// # Errors
    /// [`Error::Device`] if the material has another number of terms, [`Error::Unsupported`] if it is too large.
    pub fn prepare(&self, gpu: &Gpu, material: &SeparableMaterial, light: &PatchLight) -> Result<SeparablePatch> {
        material.expect(self.terms)?;
        let header = material.header();
        let size = [header.width, header.height];
        light.expect(size)?;
        let nearest = nearest(gpu, header.addressing);
        let nearest = BindingResource::Sampler(&nearest);
        let cascade = Cascade::new(gpu, &self.blur, material, &nearest, size)?;
        let texture = BindingResource::TextureView;
        let [rows, _] = &material.stages()[0];
        let [_, columns] = &material.stages()[material.stages().len() - 1];
        let factors = texture(&material.layers.all);
        let of_first = [rows.as_entire_binding(), nearest.clone(), factors.clone(), texture(light.view())];
        let of_last = [
            columns.as_entire_binding(),
            nearest.clone(),
            texture(&cascade.maps[1].all),
            texture(&cascade.sums_before_last().all),
            factors,
        ];
        let surface = gpu.texture(&TextureSpec::target("exitance", size, MAP))?;
        Ok(SeparablePatch {
            first: self.first.bind(gpu, 0, &of_first)?,
            last: self.last.bind(gpu, 0, &of_last)?,
            cascade,
            exitance: Exitance::new(surface, size),
        })
    }

    /// Exitance of the whole patch.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub fn draw<'a>(&self, gpu: &Gpu, patch: &'a SeparablePatch) -> Result<&'a Exitance> {
        let ends =
            Ends { first: (&self.first, &patch.first), last: (&self.last, &patch.last), target: patch.exitance.view() };
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            patch.cascade.record(&mut encoder, &self.blur, Some(ends));
            gpu.queue.submit([encoder.finish()]);
        })?;
        Ok(&patch.exitance)
    }
}

/// Renders flat patches with one kernel for all pixels: what heterogeneity is compared with.
#[derive(Debug)]
pub struct HomogeneousRenderer {
    pass: CoverPass,
}

/// A patch under a light and one kernel, ready to be drawn any number of times.
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
        gpu.expect_halves("blurs on flat patches")?;
        let slots = [Slot::Uniform, Slot::Nearest, Slot::Float];
        Ok(Self { pass: CoverPass::new(gpu, source::HOMOGENEOUS, "homogeneous", &[&slots], &[MAP])? })
    }

    /// Makes room for a patch; `kernel` as [`subsurf_shaders::separable::mean_kernel`] has it.
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
        let [rows, columns] = Kernel::new(kernel).map(|block| gpu.uniform("kernel", &block));
        let between = gpu.texture(&TextureSpec::target("between rows and columns", size, MAP))?;
        let bind = |block: &Buffer, image: &TextureView| {
            let image = BindingResource::TextureView(image);
            self.pass.bind(gpu, 0, &[block.as_entire_binding(), BindingResource::Sampler(&nearest), image])
        };
        let groups = [bind(&rows, light.view())?, bind(&columns, &between.view)?];
        let surface = gpu.texture(&TextureSpec::target("exitance", size, MAP))?;
        Ok(HomogeneousPatch { between, groups, exitance: Exitance::new(surface, size), size })
    }

    /// Exitance of the whole patch.
    ///
    /// # Errors
    /// [`Error::Device`].
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

impl SeparablePatch {
    /// What was drawn last.
    #[must_use]
    pub fn into_exitance(self) -> Exitance {
        self.exitance
    }

    /// Bytes of the maps on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        self.cascade.bytes()
    }
}

/// Texels as they stand there; beyond the border as the patch says.
fn nearest(gpu: &Gpu, addressing: Addressing) -> Sampler {
    let mode = match addressing {
        Addressing::Clamp => AddressMode::ClampToEdge,
        Addressing::Repeat => AddressMode::Repeat,
        Addressing::Mirror => AddressMode::MirrorRepeat,
    };
    gpu.device.create_sampler(&SamplerDescriptor {
        label: Some("patch"),
        address_mode_u: mode,
        address_mode_v: mode,
        ..Default::default()
    })
}
