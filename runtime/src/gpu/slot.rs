//! Kinds of bindings, as shaders declare them.

use subsurf_shaders::source::Keeping;
use wgpu::{
    BindGroupLayoutEntry, BindingType, BufferBindingType, SamplerBindingType, ShaderStages, TextureSampleType,
    TextureViewDimension,
};

/// Kind of one binding of a bind group.
#[derive(Clone, Copy)]
pub(crate) enum Slot {
    /// Uniform block.
    Uniform,
    /// Float texture, loaded texel by texel and never filtered.
    Float,
    /// Array of float textures, never filtered.
    FloatLayers,
    /// What passes keep, [`Gpu::kept`].
    Kept,
    /// Layers of it.
    KeptLayers,
    /// Float texture that is filtered.
    Filtered,
    /// Array of float textures that are filtered.
    FilteredLayers,
    /// Sampler that filters.
    Sampler,
    /// Sampler that does not filter, but wraps coordinates.
    Nearest,
    /// Texture of unsigned integers.
    Uint,
    /// Array of textures of unsigned integers.
    UintLayers,
}

/// Layout entries of a bind group whose bindings, from 0 on, are `slots`; both shader stages see them.
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
