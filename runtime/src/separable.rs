//! Draws a flat patch from its factors: weighted irradiance maps, a cascade of Gaussians, one sum.

use subsurf_decoder::bssrdf::Header;
use subsurf_shaders::source::{self, Domain};
use subsurf_shaders::uniform::{Kernel, PatchDomain};
use wgpu::{BindGroup, BindingResource, Buffer, CommandEncoderDescriptor, TextureFormat, TextureView};

use crate::cascade::{BlurPasses, Cascade, MAP};
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
    weigh: CoverPass,
    blur: BlurPasses,
    combine: CoverPass,
}

/// A factorised patch under a light, ready to be drawn any number of times.
#[derive(Debug)]
pub struct SeparablePatch {
    cascade: Cascade,
    weigh: BindGroup,
    combine: BindGroup,
    exitance: Exitance,
    size: [u32; 2],
}

impl SeparableRenderer {
    /// Compiles the passes.
    ///
    /// # Errors
    /// [`crate::Error::Device`] if the driver refuses them.
    pub fn new(gpu: &Gpu, terms: usize) -> Result<Self> {
        let maps = vec![MAP; terms];
        let of_weigh = [Slot::FilteredLayers, Slot::Float];
        let of_combine = [Slot::FilteredLayers, Slot::FloatLayers];
        Ok(Self {
            terms,
            weigh: CoverPass::new(gpu, source::weigh(terms), "weigh", &[&of_weigh], &maps)?,
            blur: BlurPasses::new(gpu, Domain::Patch, terms)?,
            combine: CoverPass::new(gpu, source::combine(terms), "combine", &[&of_combine], &[MAP])?,
        })
    }

    /// Makes room for the maps of a patch.
    ///
    /// # Errors
    /// [`Error::Device`] if the material has another number of terms, [`Error::Unsupported`] if it is too large.
    pub fn prepare(&self, gpu: &Gpu, material: &SeparableMaterial, light: &PatchLight) -> Result<SeparablePatch> {
        if material.terms() != self.terms {
            let (have, want) = (material.terms(), self.terms);
            return Err(Error::Device(format!("this renderer draws L = {want}, the material has L = {have}")));
        }
        let header = material.header();
        let size = [header.width, header.height];
        light.expect(size)?;
        let domain = gpu.uniform("patch", &PatchDomain::new(header));
        let cascade = Cascade::new(gpu, &self.blur, material, &domain, size)?;
        let texture = BindingResource::TextureView;
        let of_weigh = [texture(&material.layers.all), texture(light.view())];
        let of_combine = [texture(&material.layers.all), texture(&cascade.sums().all)];
        let surface = gpu.texture(&TextureSpec::target("exitance", size, TextureFormat::Rgba16Float))?;
        Ok(SeparablePatch {
            weigh: self.weigh.bind(gpu, 0, &of_weigh)?,
            combine: self.combine.bind(gpu, 0, &of_combine)?,
            cascade,
            exitance: Exitance::new(surface, size),
            size,
        })
    }

    /// Exitance of the whole patch.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub fn draw<'a>(&self, gpu: &Gpu, patch: &'a SeparablePatch) -> Result<&'a Exitance> {
        let all = Rows::all(patch.size);
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let maps: Vec<&TextureView> = patch.cascade.maps[0].layers.iter().collect();
            self.weigh.record(&mut encoder, &maps, &[&patch.weigh], all);
            patch.cascade.record(&mut encoder, &self.blur);
            self.combine.record(&mut encoder, &[patch.exitance.view()], &[&patch.combine], all);
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
    /// [`Error::Device`] if the driver refuses it.
    pub fn new(gpu: &Gpu) -> Result<Self> {
        let slots = [Slot::Uniform, Slot::Uniform, Slot::Float];
        Ok(Self { pass: CoverPass::new(gpu, source::HOMOGENEOUS, "homogeneous", &[&slots], &[MAP])? })
    }

    /// Makes room for a patch; `kernel` as [`subsurf_shaders::separable::mean_kernel`] has it.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if it is too large.
    pub fn prepare(
        &self,
        gpu: &Gpu,
        header: &Header,
        kernel: &[[f32; 3]],
        light: &PatchLight,
    ) -> Result<HomogeneousPatch> {
        let size = [header.width, header.height];
        light.expect(size)?;
        let domain = gpu.uniform("patch", &PatchDomain::new(header));
        let [rows, columns] = Kernel::new(kernel).map(|block| gpu.uniform("kernel", &block));
        let between = gpu.texture(&TextureSpec::target("between rows and columns", size, MAP))?;
        let bind = |block: &Buffer, image: &TextureView| {
            let image = BindingResource::TextureView(image);
            self.pass.bind(gpu, 0, &[block.as_entire_binding(), domain.as_entire_binding(), image])
        };
        let groups = [bind(&rows, light.view())?, bind(&columns, &between.view)?];
        let surface = gpu.texture(&TextureSpec::target("exitance", size, TextureFormat::Rgba16Float))?;
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
