//! Puts a picture into the window, how far it is off, or what it is compared with beside it.

use subsurf_runtime::Gpu;
use subsurf_runtime::wgpu::{
    BindGroup, BindGroupDescriptor, BindGroupEntry, BindGroupLayout, BindGroupLayoutDescriptor, BindGroupLayoutEntry,
    BindingResource, BindingType, FragmentState, MultisampleState, PipelineCompilationOptions,
    PipelineLayoutDescriptor, PrimitiveState, RenderPass, RenderPipeline, RenderPipelineDescriptor,
    ShaderModuleDescriptor, ShaderSource, ShaderStages, TextureFormat, TextureSampleType, TextureView,
    TextureViewDimension, VertexState,
};

/// Choice of what the window shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::window) enum Shows {
    /// The picture alone.
    Picture,
    /// Ten times the difference of display values.
    Difference,
    /// The picture on the left, what it is compared with on the right.
    Split,
}

/// Pipelines that cover a window of one format.
pub(in crate::window) struct Composer {
    layout: BindGroupLayout,
    picture: RenderPipeline,
    difference: RenderPipeline,
    split: RenderPipeline,
}

impl Composer {
    pub(in crate::window) fn new(gpu: &Gpu, format: TextureFormat) -> Self {
        let device = gpu.device();
        let image = |binding| BindGroupLayoutEntry {
            binding,
            visibility: ShaderStages::FRAGMENT,
            ty: BindingType::Texture {
                sample_type: TextureSampleType::Float { filterable: false },
                view_dimension: TextureViewDimension::D2,
                multisampled: false,
            },
            count: None,
        };
        let layout = device.create_bind_group_layout(&BindGroupLayoutDescriptor {
            label: Some("compose"),
            entries: &[image(0), image(1)],
        });
        let module = device.create_shader_module(ShaderModuleDescriptor {
            label: Some("compose"),
            source: ShaderSource::Wgsl(include_str!("compose.wgsl").into()),
        });
        let pipeline_layout = device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("compose"),
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let constants = [("encodes", f64::from(u8::from(format.is_srgb())))];
        let pipeline = |fragment| {
            device.create_render_pipeline(&RenderPipelineDescriptor {
                label: Some(fragment),
                layout: Some(&pipeline_layout),
                vertex: VertexState {
                    module: &module,
                    entry_point: Some("cover"),
                    compilation_options: PipelineCompilationOptions::default(),
                    buffers: &[],
                },
                primitive: PrimitiveState::default(),
                depth_stencil: None,
                multisample: MultisampleState::default(),
                fragment: Some(FragmentState {
                    module: &module,
                    entry_point: Some(fragment),
                    compilation_options: PipelineCompilationOptions { constants: &constants, ..Default::default() },
                    targets: &[Some(format.into())],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let [picture, difference, split] = ["plain", "difference", "split"].map(pipeline);
        Self { layout, picture, difference, split }
    }

    /// Binds a picture, and what it is compared with.
    pub(in crate::window) fn bind(&self, gpu: &Gpu, picture: &TextureView, reference: &TextureView) -> BindGroup {
        let entry = |(binding, view)| BindGroupEntry { binding, resource: BindingResource::TextureView(view) };
        gpu.device().create_bind_group(&BindGroupDescriptor {
            label: Some("compose"),
            layout: &self.layout,
            entries: &[(0, picture), (1, reference)].map(entry),
        })
    }

    pub(in crate::window) fn record(&self, pass: &mut RenderPass<'_>, pictures: &BindGroup, shows: Shows) {
        pass.set_pipeline(match shows {
            Shows::Picture => &self.picture,
            Shows::Difference => &self.difference,
            Shows::Split => &self.split,
        });
        pass.set_bind_group(0, pictures, &[]);
        pass.draw(0..3, 0..1);
    }
}
