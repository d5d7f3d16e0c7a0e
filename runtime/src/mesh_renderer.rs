//! Draws a mesh: irradiance at its points, exchange between them, and the picture.

use glam::Vec3;
use glam::camera::rh::proj::directx::perspective;
use glam::camera::rh::view::look_at_mat4;
use subsurf_shaders::cpu::diffuse_transmittance;
use subsurf_shaders::{Storage, source, uniform};
use wgpu::{
    BindGroupLayout, BindingResource, Buffer, BufferUsages, Color, ColorTargetState, ColorWrites,
    CommandEncoderDescriptor, CompareFunction, DepthStencilState, FragmentState, IndexFormat, LoadOp, MultisampleState,
    Operations, PipelineLayoutDescriptor, PrimitiveState, RenderPassDepthStencilAttachment,
    RenderPassDescriptor, RenderPipeline, RenderPipelineDescriptor, ShaderModuleDescriptor, ShaderSource, StoreOp,
    TextureFormat, TextureUsages, VertexBufferLayout, VertexState, VertexStepMode, vertex_attr_array,
};

use crate::context::Gpu;
use crate::error::{Error, Result};
use crate::ledger::Tracked;
use crate::material::{Material, slots};
use crate::pass::{CoverPass, Rows, attachment, bind, bind_group_layouts};
use crate::resource::{ROW, Slot, Surface2d, TextureSpec, array_size};
use crate::scene::{Mesh, Surface};

/// Light on a mesh.
#[derive(Clone, Copy, Debug)]
pub struct MeshLight {
    /// Towards the light; need not be of unit length.
    pub direction: Vec3,
    /// Irradiance on a plane that faces the light, linear Rec. 709.
    pub irradiance: [f32; 3],
    /// Irradiance from all around, linear Rec. 709.
    pub sky: [f32; 3],
}

impl MeshLight {
    /// The uniform block for a material of index `eta`.
    #[must_use]
    pub fn block(&self, eta: f32) -> uniform::Light {
        uniform::Light {
            direction: self.direction.normalize_or(Vec3::Y).into(),
            pad_0: 0.0,
            irradiance: self.irradiance,
            pad_1: 0.0,
            sky: self.sky,
            sky_transmittance: diffuse_transmittance(eta),
            eta,
            pad_2: [0.0; 3],
        }
    }
}

/// Where the picture is taken from.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Eye, in mm.
    pub eye_mm: Vec3,
    /// What the eye looks at, in mm.
    pub target_mm: Vec3,
    /// Vertical angle of view in radians.
    pub angle: f32,
    /// Multiplies radiance before tone mapping.
    pub exposure: f32,
    /// Irradiance from all around, linear Rec. 709, as in the light: what does not enter is reflected.
    pub sky: [f32; 3],
}

impl View {
    /// The uniform block for a picture of `size` and a material of index `eta`.
    #[must_use]
    pub fn block(&self, size: [u32; 2], eta: f32) -> uniform::Camera {
        #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
        let aspect = size[0] as f32 / size[1] as f32;
        let distance = self.eye_mm.distance(self.target_mm);
        let clip_from_view = perspective(self.angle, aspect, 0.05 * distance, 20.0 * distance);
        let view_from_world = look_at_mat4(self.eye_mm, self.target_mm, Vec3::Y);
        uniform::Camera {
            clip_from_world: (clip_from_view * view_from_world).to_cols_array_2d(),
            eye_mm: self.eye_mm.into(),
            exposure: self.exposure,
            exit_scale: 1.0 / diffuse_transmittance(eta),
            eta,
            row: ROW,
            pad_0: 0,
            sky: self.sky.map(|sky| sky / std::f32::consts::PI),
            pad_1: 0,
        }
    }
}

/// Renders meshes in materials of one storage; its pipelines are made once.
#[derive(Debug)]
pub struct MeshRenderer {
    storage: Storage,
    irradiance: CoverPass,
    gather: CoverPass,
    shade: RenderPipeline,
    shade_group: BindGroupLayout,
}

/// A mesh on the device.
#[derive(Debug)]
pub struct GpuMesh {
    grid: Tracked<Buffer>,
    positions: Surface2d,
    normals: Surface2d,
    pixels: Surface2d,
    cell_starts: Surface2d,
    vertices: Tracked<Buffer>,
    indices: Tracked<Buffer>,
    index_count: u32,
    points: usize,
}

/// Light that leaves a mesh at each of its points, on the device.
#[derive(Debug)]
pub struct MeshExitance {
    surface: Surface2d,
    points: usize,
}

/// A vertex of the picture.
#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Vertex {
    position_mm: Vec3,
    normal: Vec3,
    point: u32,
}

const DEPTH: TextureFormat = TextureFormat::Depth24Plus;
/// Dark grey, as 8-bit display value.
pub const BACKGROUND: u8 = 46;

impl MeshRenderer {
    /// Compiles the passes for a storage.
    ///
    /// # Errors
    /// [`Error::Device`] if the driver refuses them; captures are not drawn on meshes.
    pub fn new(gpu: &Gpu, storage: Storage) -> Result<Self> {
        if storage == Storage::Capture {
            return Err(Error::Device("captures are drawn flat, not on meshes".to_owned()));
        }
        let gather = source::surface_gather(storage);
        let of_points = [Slot::Uniform, Slot::Float, Slot::Uint, Slot::Uint, Slot::Float];
        let of_light: [&[Slot]; 1] = [&[Slot::Uniform, Slot::Float]];
        let shade_group = bind_group_layouts(gpu, &of_light).remove(0);
        let half = &[TextureFormat::Rgba16Float];
        Ok(Self {
            storage,
            irradiance: CoverPass::new(gpu, source::IRRADIANCE, "irradiance", &of_light, half)?,
            gather: CoverPass::new(gpu, gather, "surface_gather", &[slots(storage), &of_points], half)?,
            shade: shade_pipeline(gpu, &shade_group)?,
            shade_group,
        })
    }

    /// Light that leaves the mesh: irradiance at every point, then Σ Rd(x_i, x_o) E(x_i) dA over their neighbours.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub fn exitance(&self, gpu: &Gpu, material: &Material, mesh: &GpuMesh, light: &MeshLight) -> Result<MeshExitance> {
        material.expect(self.storage)?;
        let size = array_size(mesh.points);
        let target = |label| gpu.texture(&TextureSpec::target(label, size, TextureFormat::Rgba16Float));

        let irradiance = target("irradiance")?;
        let block = gpu.uniform("light", &light.block(material.header().eta));
        let group = [block.as_entire_binding(), BindingResource::TextureView(&mesh.normals.view)];
        let group = self.irradiance.bind(gpu, 0, &group)?;
        self.irradiance.draw(gpu, &irradiance.view, &[&group], Rows::all(size))?;

        let exitance = target("exitance")?;
        let of_material = self.gather.bind(gpu, 0, &material.resources())?;
        let of_points = [
            mesh.grid.as_entire_binding(),
            BindingResource::TextureView(&mesh.positions.view),
            BindingResource::TextureView(&mesh.cell_starts.view),
            BindingResource::TextureView(&mesh.pixels.view),
            BindingResource::TextureView(&irradiance.view),
        ];
        let of_points = self.gather.bind(gpu, 1, &of_points)?;
        // A point seldom has more than a few thousand others within reach.
        for rows in Rows::bands(size, u64::from(ROW) * 4_096) {
            self.gather.draw(gpu, &exitance.view, &[&of_material, &of_points], rows)?;
        }
        Ok(MeshExitance { surface: exitance, points: mesh.points })
    }

    /// The picture: `size` pixels of 8-bit sRGB, row by row from the top.
    ///
    /// # Errors
    /// [`Error::Device`], [`Error::Unsupported`] for pictures larger than a texture.
    pub fn picture(
        &self,
        gpu: &Gpu,
        mesh: &GpuMesh,
        exitance: &MeshExitance,
        camera: &uniform::Camera,
        size: [u32; 2],
    ) -> Result<Vec<[u8; 3]>> {
        let colour = gpu.texture(&TextureSpec::target("picture", size, TextureFormat::Rgba8Unorm))?;
        let depth =
            TextureSpec { usage: TextureUsages::RENDER_ATTACHMENT, ..TextureSpec::target("depth", size, DEPTH) };
        let depth = gpu.texture(&depth)?;
        let camera = gpu.uniform("camera", camera);
        let group = [camera.as_entire_binding(), BindingResource::TextureView(&exitance.surface.view)];
        let group = bind(gpu, &self.shade_group, &group)?;
        gpu.checked(|| {
            let mut encoder = gpu.device.create_command_encoder(&CommandEncoderDescriptor::default());
            let grey = f64::from(BACKGROUND) / 255.0;
            let mut pass = encoder.begin_render_pass(&RenderPassDescriptor {
                label: Some("shade"),
                color_attachments: &[Some(attachment(
                    &colour.view,
                    LoadOp::Clear(Color { r: grey, g: grey, b: grey, a: 1.0 }),
                ))],
                depth_stencil_attachment: Some(RenderPassDepthStencilAttachment {
                    view: &depth.view,
                    depth_ops: Some(Operations { load: LoadOp::Clear(1.0), store: StoreOp::Discard }),
                    stencil_ops: None,
                }),
                timestamp_writes: None,
                occlusion_query_set: None,
                multiview_mask: None,
            });
            pass.set_pipeline(&self.shade);
            pass.set_bind_group(0, &group, &[]);
            pass.set_vertex_buffer(0, mesh.vertices.slice(..));
            pass.set_index_buffer(mesh.indices.slice(..), IndexFormat::Uint32);
            pass.draw_indexed(0..mesh.index_count, 0, 0..1);
            drop(pass);
            gpu.queue.submit([encoder.finish()]);
        })?;
        let texels: Vec<[u8; 4]> = gpu.read(&colour.texture)?;
        Ok(texels.iter().map(|[r, g, b, _]| [*r, *g, *b]).collect())
    }
}

impl GpuMesh {
    /// Uploads a mesh and its points.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no textures or buffers of that size.
    pub fn upload(gpu: &Gpu, mesh: &Mesh, surface: &Surface) -> Result<Self> {
        let table = |label, len, format, bytes: &[u8]| gpu.filled(&TextureSpec::array(label, len, format), bytes);
        let points = surface.len();
        let vertices = mesh.positions.iter().zip(&mesh.normals).zip(&surface.point_of);
        let vertices: Vec<Vertex> = vertices
            .map(|((position_mm, normal), point)| Vertex { position_mm: *position_mm, normal: *normal, point: *point })
            .collect();
        let limit = gpu.device.limits().max_buffer_size;
        let need = (size_of_val(&vertices[..]) as u64).max(size_of_val(&mesh.triangles[..]) as u64);
        if need > limit {
            return Err(Error::Unsupported { what: "buffers", need, have: limit });
        }
        let index_count = u32::try_from(3 * mesh.triangles.len());
        Ok(Self {
            grid: gpu.uniform("grid", &surface.grid),
            positions: table(
                "positions",
                points,
                TextureFormat::Rgba32Float,
                bytemuck::cast_slice(&surface.positions),
            )?,
            normals: table("normals", points, TextureFormat::Rgba32Float, bytemuck::cast_slice(&surface.normals))?,
            pixels: table("pixels", points, TextureFormat::Rg16Uint, bytemuck::cast_slice(&surface.pixels))?,
            cell_starts: table(
                "cell starts",
                surface.cell_starts.len(),
                TextureFormat::R32Uint,
                bytemuck::cast_slice(&surface.cell_starts),
            )?,
            vertices: gpu.buffer("vertices", bytemuck::cast_slice(&vertices), BufferUsages::VERTEX),
            indices: gpu.buffer("indices", bytemuck::cast_slice(&mesh.triangles), BufferUsages::INDEX),
            index_count: index_count.map_err(|_| Error::Mesh("more than 2³² indices".to_owned()))?,
            points,
        })
    }
}

impl MeshExitance {
    /// Reads it back, linear rgb by point.
    ///
    /// # Errors
    /// [`Error::Device`].
    pub fn read(&self, gpu: &Gpu) -> Result<Vec<[f32; 3]>> {
        let mut texels = gpu.read_rgb(&self.surface.texture)?;
        texels.truncate(self.points);
        Ok(texels)
    }
}

fn shade_pipeline(gpu: &Gpu, group: &BindGroupLayout) -> Result<RenderPipeline> {
    gpu.checked(|| {
        let module = gpu.device.create_shader_module(ShaderModuleDescriptor {
            label: Some("shade"),
            source: ShaderSource::Wgsl(source::SHADE.into()),
        });
        let layout = gpu.device.create_pipeline_layout(&PipelineLayoutDescriptor {
            label: Some("shade"),
            bind_group_layouts: &[Some(group)],
            immediate_size: 0,
        });
        let attributes = vertex_attr_array![0 => Float32x3, 1 => Float32x3, 2 => Uint32];
        gpu.device.create_render_pipeline(&RenderPipelineDescriptor {
            label: Some("shade"),
            layout: Some(&layout),
            vertex: VertexState {
                module: &module,
                entry_point: Some("project"),
                compilation_options: Default::default(),
                buffers: &[Some(VertexBufferLayout {
                    array_stride: size_of::<Vertex>() as u64,
                    step_mode: VertexStepMode::Vertex,
                    attributes: &attributes,
                })],
            },
            primitive: PrimitiveState::default(),
            depth_stencil: Some(DepthStencilState {
                format: DEPTH,
                depth_write_enabled: Some(true),
                depth_compare: Some(CompareFunction::Less),
                stencil: Default::default(),
                bias: Default::default(),
            }),
            multisample: MultisampleState::default(),
            fragment: Some(FragmentState {
                module: &module,
                entry_point: Some("shade"),
                compilation_options: Default::default(),
                targets: &[Some(ColorTargetState {
                    format: TextureFormat::Rgba8Unorm,
                    blend: None,
                    write_mask: ColorWrites::ALL,
                })],
            }),
            multiview_mask: None,
            cache: None,
        })
    })
}
