//! Pipelines of the techniques that a host wants; made at load, never in a frame.

use std::fmt::Debug;
use std::sync::Arc;

use subsurf_shaders::{BtfLayout, MaterialLayout};

use super::options::RuntimeOptions;
use super::plan::LEAST_LIGHT_TEXELS;
use crate::error::{Error, Result};
use crate::gpu::{BLOCK_STRIDE, Gpu};
#[cfg(feature = "reference")]
use crate::technique::linsss;
#[cfg(feature = "transfer")]
use crate::technique::transfer;
use crate::technique::{Technique, TsmPasses, btf, gather, kernel, separable, splat};

/// Pipelines of the techniques that a host wants; made at load, never in a frame.
#[derive(Debug)]
pub struct Renderer {
    pub(super) options: RuntimeOptions,
    pub(super) tsm: TsmPasses,
    pub(super) gather: Compiled<MaterialLayout, gather::Passes>,
    pub(super) splat: Compiled<MaterialLayout, splat::Passes>,
    pub(super) separable: Compiled<usize, separable::Passes>,
    #[cfg(feature = "reference")]
    pub(super) linsss: Compiled<(), linsss::Passes>,
    pub(super) btf: Compiled<BtfLayout, btf::Passes>,
    pub(super) kernel: Compiled<(), kernel::Passes>,
    #[cfg(feature = "transfer")]
    pub(super) transfer: Compiled<(), transfer::Passes>,
}

/// Pipelines of one technique, by what they depend on.
#[derive(Debug)]
pub(super) struct Compiled<K, P>(Vec<(K, Arc<P>)>);

impl<K: PartialEq + Copy + Debug, P> Compiled<K, P> {
    fn add(&mut self, key: K, compile: impl FnOnce() -> Result<P>) -> Result<()> {
        if self.0.iter().all(|(of, _)| *of != key) {
            self.0.push((key, Arc::new(compile()?)));
        }
        Ok(())
    }

    /// Pipelines for a key.
    ///
    /// # Errors
    /// [`Error::Usage`] if they were not compiled.
    pub(super) fn of(&self, key: K) -> Result<&Arc<P>> {
        let missing = || Error::Usage(format!("no pipelines for {key:?}: call Renderer::compile at load"));
        self.0.iter().find(|(of, _)| *of == key).map(|(_, passes)| passes).ok_or_else(missing)
    }
}

impl Renderer {
    /// Compiles what all techniques share.
    ///
    /// # Errors
    /// [`Error::Usage`] if an option is out of range; [`Error::Unsupported`] if it is beyond the device; [`Error::Device`] if
    /// the driver refuses a pass.
    pub fn new(gpu: &Gpu, options: RuntimeOptions) -> Result<Self> {
        let RuntimeOptions { light_texels, map_bytes_per_pixel, objects, samples, depth, .. } = options;
        let limits = gpu.device.limits();
        if !light_texels.is_power_of_two() || light_texels < LEAST_LIGHT_TEXELS {
            return Err(Error::Usage(format!(
                "light_texels is {light_texels}; it must be a power of two, at least {LEAST_LIGHT_TEXELS}"
            )));
        }
        if map_bytes_per_pixel.is_nan() || map_bytes_per_pixel <= 0.0 {
            return Err(Error::Usage(format!("map_bytes_per_pixel is {map_bytes_per_pixel}; it must be more than 0")));
        }
        if objects == 0 {
            return Err(Error::Usage("objects is 0: a frame needs room for one at least".to_owned()));
        }
        if !matches!(samples, 1 | 4) {
            return Err(Error::Usage(format!("samples is {samples}; it must be 1 or 4")));
        }
        if !depth.format.has_depth_aspect() {
            return Err(Error::Usage(format!("the depth is of format {:?}, which holds none", depth.format)));
        }
        let (need, have) = (u64::from(objects) * u64::from(BLOCK_STRIDE), limits.max_buffer_size.min(1 << 31));
        if need > have {
            return Err(Error::Unsupported { what: "bytes of objects", need, have });
        }
        if light_texels > limits.max_texture_dimension_2d {
            let (need, have) = (light_texels.into(), limits.max_texture_dimension_2d.into());
            return Err(Error::Unsupported { what: "texels of a light's view", need, have });
        }
        Ok(Self {
            options,
            tsm: TsmPasses::new(gpu)?,
            gather: Compiled(Vec::new()),
            splat: Compiled(Vec::new()),
            separable: Compiled(Vec::new()),
            #[cfg(feature = "reference")]
            linsss: Compiled(Vec::new()),
            btf: Compiled(Vec::new()),
            kernel: Compiled(Vec::new()),
            #[cfg(feature = "transfer")]
            transfer: Compiled(Vec::new()),
        })
    }

    /// Compiles what all techniques share, and one technique.
    ///
    /// # Errors
    /// As [`Renderer::new`] and [`Renderer::compile`].
    pub fn for_technique(gpu: &Gpu, technique: Technique, options: RuntimeOptions) -> Result<Self> {
        let mut renderer = Self::new(gpu, options)?;
        renderer.compile(gpu, technique)?;
        Ok(renderer)
    }

    /// Compiles the passes of a technique, unless they are.
    ///
    /// # Errors
    /// [`Error::Device`] if the driver refuses them; [`Error::Usage`] for captures, which are not drawn on meshes;
    /// [`Error::NoHalfFloats`] for splats where there is nothing to add them up in.
    pub fn compile(&mut self, gpu: &Gpu, technique: Technique) -> Result<()> {
        let options = &self.options;
        match technique {
            Technique::Gather(MaterialLayout::Capture) | Technique::Splat(MaterialLayout::Capture) => {
                Err(Error::Usage("captures are drawn flat, not on meshes".to_owned()))
            }
            Technique::Gather(layout) => self.gather.add(layout, || gather::Passes::new(gpu, layout, options)),
            Technique::Splat(layout) => self.splat.add(layout, || splat::Passes::new(gpu, layout, options)),
            Technique::Separable(terms) => self.separable.add(terms, || separable::Passes::new(gpu, terms, options)),
            #[cfg(feature = "reference")]
            Technique::Linsss => self.linsss.add((), || linsss::Passes::new(gpu, options)),
            Technique::Btf(layout) => self.btf.add(layout, || btf::Passes::new(gpu, layout, options)),
            Technique::Kernel => self.kernel.add((), || kernel::Passes::new(gpu, options)),
            #[cfg(feature = "transfer")]
            Technique::Transfer => self.transfer.add((), || transfer::Passes::new(gpu, options)),
        }
    }

    /// Options that it was made with.
    #[must_use]
    pub fn options(&self) -> &RuntimeOptions {
        &self.options
    }
}
