//! Bind group layouts of passes.

use subsurf_shaders::TargetFormat;
use subsurf_shaders::passes::Binding;
use wgpu::{
    BindGroupLayoutEntry, BindingType, BufferBindingType, SamplerBindingType, ShaderStages, TextureSampleType,
    TextureViewDimension,
};

/// Layout entries of a bind group whose bindings, from 0 on, are `bindings`; both shader stages see them.
pub(crate) fn layout_entries(bindings: &[Binding], format: TargetFormat) -> Vec<BindGroupLayoutEntry> {
    let texture =
        |sample_type, view_dimension| BindingType::Texture { sample_type, view_dimension, multisampled: false };
    let uniform = |has_dynamic_offset| BindingType::Buffer {
        ty: BufferBindingType::Uniform,
        has_dynamic_offset,
        min_binding_size: None,
    };
    let unfiltered = TextureSampleType::Float { filterable: false };
    let target = match format {
        TargetFormat::Half => unfiltered,
        TargetFormat::Packed => TextureSampleType::Uint,
    };
    let filtered = TextureSampleType::Float { filterable: true };
    let numbered = bindings.iter().zip(0..);
    numbered
        .map(|(kind, binding)| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::VERTEX_FRAGMENT,
            ty: match kind {
                Binding::Uniform => uniform(false),
                Binding::Object => uniform(true),
                Binding::Float => texture(unfiltered, TextureViewDimension::D2),
                Binding::FloatLayers => texture(unfiltered, TextureViewDimension::D2Array),
                Binding::Target => texture(target, TextureViewDimension::D2),
                Binding::TargetLayers => texture(target, TextureViewDimension::D2Array),
                Binding::Filtered => texture(filtered, TextureViewDimension::D2),
                Binding::FilteredLayers => texture(filtered, TextureViewDimension::D2Array),
                Binding::Sampler => BindingType::Sampler(SamplerBindingType::Filtering),
                Binding::Nearest => BindingType::Sampler(SamplerBindingType::NonFiltering),
                Binding::Uint => texture(TextureSampleType::Uint, TextureViewDimension::D2),
                Binding::UintLayers => texture(TextureSampleType::Uint, TextureViewDimension::D2Array),
            },
            count: None,
        })
        .collect()
}
