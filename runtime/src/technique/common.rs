//! What all techniques bind of a frame: its blocks, and the environment that coats reflect.

use half::f16;
use subsurf_scene::{Environment, REFLECTION_LEVELS, REFLECTION_SIZE};
use subsurf_shaders::uniform;
use wgpu::{
    AddressMode, BindGroup, BindingResource, Buffer, BufferBinding, BufferSize, BufferUsages, FilterMode,
    MipmapFilterMode, Sampler, SamplerDescriptor, TextureFormat,
};

use super::host_shadow::HostShadows;
use super::mesh_pass::{MeshPass, SharedGroups};
use crate::error::Result;
use crate::gpu::{BLOCK_STRIDE, Gpu, Purpose, Surface2d, TextureSpec, Tracked};

/// Blocks and reflections of a frame on the device.
#[derive(Debug)]
pub(crate) struct Common {
    pub(crate) scene: Tracked<Buffer>,
    pub(crate) objects: Tracked<Buffer>,
    /// Bind group 2 of passes over meshes: the block at an offset of `objects`.
    pub(crate) object: BindGroup,
    pub(crate) host_shadows: HostShadows,
    pub(crate) reflections: Surface2d,
    /// Levels of the environment that `reflections` shows.
    shown: Vec<Vec<[f32; 3]>>,
}

impl Common {
    /// Bytes on the device for so many objects.
    pub(crate) fn bytes_of(objects: u32) -> u64 {
        let texels = |level: u32| u64::from(REFLECTION_SIZE[0] >> level) * u64::from(REFLECTION_SIZE[1] >> level);
        let reflections = 8 * (0..REFLECTION_LEVELS).map(texels).sum::<u64>();
        size_of::<uniform::Scene>() as u64 + u64::from(objects) * u64::from(BLOCK_STRIDE) + reflections
    }

    /// Makes room for so many objects; `pass` is any over meshes.
    pub(crate) fn new(gpu: &Gpu, pass: &MeshPass, objects: u32) -> Result<Self> {
        let spec = TextureSpec {
            purpose: Purpose::Frame,
            ..TextureSpec::table("reflections", REFLECTION_SIZE, TextureFormat::Rgba16Float)
        };
        let blocks = vec![0; objects as usize * BLOCK_STRIDE as usize];
        let objects = gpu.buffer(Purpose::Frame, "objects", &blocks, BufferUsages::UNIFORM);
        let one = BindingResource::Buffer(BufferBinding {
            buffer: &objects,
            offset: 0,
            size: BufferSize::new(size_of::<uniform::Object>() as u64),
        });
        Ok(Self {
            scene: gpu.uniform(Purpose::Frame, "scene", &<uniform::Scene as bytemuck::Zeroable>::zeroed()),
            object: pass.bind(gpu, 2, &[one])?,
            objects,
            host_shadows: HostShadows::new(gpu)?,
            reflections: gpu.texture(&TextureSpec { levels: REFLECTION_LEVELS, ..spec })?,
            shown: Vec::new(),
        })
    }

    /// Bind groups that passes of all materials share.
    pub(crate) fn shared(&self) -> SharedGroups<'_> {
        SharedGroups { objects: &self.object, host_shadows: self.host_shadows.group() }
    }

    /// Uploads the reflections of the environment if they are others than before.
    pub(crate) fn show(&mut self, gpu: &Gpu, environment: &Environment) {
        let levels = environment.reflections();
        if self.shown == levels {
            return;
        }
        for (pixels, level) in levels.iter().zip(0..) {
            // Half floats hold no more.
            let texels = pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0].map(|value| value.min(65_504.0)));
            let texels: Vec<u16> = texels.map(|value| f16::from_f32(value).to_bits()).collect();
            gpu.fill_level(&self.reflections.texture, 0, level, bytemuck::cast_slice(&texels));
        }
        self.shown = levels.to_vec();
    }
}

/// Sampler of reflections: repeats in u, clamps at the poles, filters.
pub(crate) fn reflection_sampler(gpu: &Gpu) -> Sampler {
    gpu.device.create_sampler(&SamplerDescriptor {
        label: Some("reflections"),
        address_mode_u: AddressMode::Repeat,
        address_mode_v: AddressMode::ClampToEdge,
        mag_filter: FilterMode::Linear,
        min_filter: FilterMode::Linear,
        mipmap_filter: MipmapFilterMode::Linear,
        ..Default::default()
    })
}
