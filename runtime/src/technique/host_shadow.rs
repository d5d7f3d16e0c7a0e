//! Shadow maps of the host's own, bound for the passes that look up visibilities of lights.

use subsurf_scene::MAX_LIGHTS;
use subsurf_shaders::passes::table::HOST_SHADOW_MAPS;
use wgpu::{BindGroup, BindGroupLayout, BindingResource, Sampler, SamplerDescriptor, TextureFormat, TextureView};

use crate::error::{Error, Result};
use crate::frame::ShadowMap;
use crate::gpu::{Gpu, Purpose, Surface2d, TextureSpec, bind, bind_group_layout};

/// Shadow maps of a host, and what is bound where it has none.
#[derive(Debug)]
pub(crate) struct HostShadows {
    layout: BindGroupLayout,
    sampler: Sampler,
    none: Surface2d,
    /// Maps that `group` has.
    bound: Vec<TextureView>,
    group: BindGroup,
}

impl HostShadows {
    /// Binds no map yet.
    pub(crate) fn new(gpu: &Gpu) -> Result<Self> {
        let layout = bind_group_layout(gpu, HOST_SHADOW_MAPS);
        let none = {
            let plain = TextureSpec::table("no shadow map", [1; 2], TextureFormat::R32Float);
            gpu.texture(&TextureSpec { purpose: Purpose::Frame, ..plain })?
        };
        // Clamps to the edge and takes the nearest texel.
        let sampler =
            gpu.device.create_sampler(&SamplerDescriptor { label: Some("shadow maps"), ..Default::default() });
        let group = group_of(gpu, &layout, &[], &none, &sampler)?;
        Ok(Self { layout, sampler, none, bound: Vec::new(), group })
    }

    /// Binds the maps of a frame, unless they are bound already.
    ///
    /// # Errors
    /// [`Error::Usage`] for a view of several layers or of stencil: a view does not say what it shows, only the device does when it
    /// is bound.
    pub(crate) fn show(&mut self, gpu: &Gpu, maps: &[ShadowMap<'_>]) -> Result<()> {
        if self.bound.iter().eq(maps.iter().map(|map| map.depth)) {
            return Ok(());
        }
        let bound: Vec<TextureView> = maps.iter().map(|map| map.depth.clone()).collect();
        let group = group_of(gpu, &self.layout, &bound, &self.none, &self.sampler);
        self.group = group.map_err(|error| self.blame(gpu, &bound).unwrap_or(error))?;
        self.bound = bound;
        Ok(())
    }

    /// Names the first map that is refused by itself, if there is one.
    fn blame(&self, gpu: &Gpu, maps: &[TextureView]) -> Option<Error> {
        let is_refused =
            |map| group_of(gpu, &self.layout, std::slice::from_ref(map), &self.none, &self.sampler).is_err();
        let number = maps.iter().position(is_refused)?;
        Some(Error::Usage(format!(
            "shadow map {number} is a view of several layers, or of stencil; expected one layer, and of depth with stencil \
             TextureAspect::DepthOnly"
        )))
    }

    /// Bind group 3.
    pub(crate) fn group(&self) -> &BindGroup {
        &self.group
    }
}

/// Binds up to [`MAX_LIGHTS`] maps, and `none` in place of the others.
fn group_of(
    gpu: &Gpu,
    layout: &BindGroupLayout,
    maps: &[TextureView],
    none: &Surface2d,
    sampler: &Sampler,
) -> Result<BindGroup> {
    let maps = maps.iter().chain(std::iter::repeat(&none.view)).take(MAX_LIGHTS);
    let mut resources: Vec<_> = maps.map(BindingResource::TextureView).collect();
    resources.push(BindingResource::Sampler(sampler));
    bind(gpu, layout, &resources)
}
