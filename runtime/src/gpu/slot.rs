//! How shaders see what is bound to them.

use subsurf_shaders::source::Keeping;
use wgpu::{
    BindGroupLayoutEntry, BindingType, BufferBindingType, SamplerBindingType, ShaderStages, TextureSampleType,
    TextureViewDimension,
};

/// How a shader sees a binding.
#[derive(Clone, Copy)]
pub(crate) enum Slot {
    /// A uniform block.
    Uniform,
    /// A float texture, loaded and never filtered.
    Float,
    /// Layers of one.
    FloatLayers,
    /// What passes keep, [`Gpu::kept`].
    Kept,
    /// Layers of it.
    KeptLayers,
    /// A float texture that is filtered.
    Filtered,
    /// Layers of one.
    FilteredLayers,
    /// What filters them.
    Sampler,
    /// One that does not filter: textures are looked up at texels, and wrapped.
    Nearest,
    /// An unsigned integer texture.
    Uint,
    /// Layers of one.
    UintLayers,
}

/// Layout entries of a bind group whose bindings are `slots`, seen by both stages.
pub(crate) fn layout_entries(slots: &[Slot], keeping: Keeping) -> Vec<BindGroupLayoutEntry> {
    let texture =
        |sample_type, view_dimension| BindingType::Texture { sample_type, view_dimension, multisampled: false };
    let unfiltered = TextureSampleType::Float { filterable: false };
    let kept = match keeping {
        Keeping::Halves => unfiltered,
        Keeping::Packed => TextureSampleType::Uint,
    };
    let filtered = TextureSampleType::Float { filterable: true };
    let bindings = slots.iter().zip(0..);
    bindings
        .map(|(slot, binding)| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: match slot {
                Slot::Uniform => BindingType::Buffer {
                    ty: BufferBindingType::Uniform,
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                Slot::Float => texture(unfiltered, TextureViewDimension::D2),
                Slot::FloatLayers => texture(unfiltered, TextureViewDimension::D2Array),
                Slot::Kept => texture(kept, TextureViewDimension::D2),
                Slot::KeptLayers => texture(kept, TextureViewDimension::D2Array),
                Slot::Filtered => texture(filtered, TextureViewDimension::D2),
                Slot::FilteredLayers => texture(filtered, TextureViewDimension::D2Array),
                Slot::Sampler => BindingType::Sampler(SamplerBindingType::Filtering),
                Slot::Nearest => BindingType::Sampler(SamplerBindingType::NonFiltering),
                Slot::Uint => texture(TextureSampleType::Uint, TextureViewDimension::D2),
                Slot::UintLayers => texture(TextureSampleType::Uint, TextureViewDimension::D2Array),
            },
            count: None,
        })
        .collect()
}
