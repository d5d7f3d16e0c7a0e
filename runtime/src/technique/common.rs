//! What all techniques bind of a scene: its block, what lights see, and the environment that coats reflect.

use half::f16;
use subsurf_scene::{REFLECTION_LEVELS, REFLECTION_SIZE, Scene};
use subsurf_shaders::uniform;
use wgpu::{
    AddressMode, Buffer, CommandEncoder, FilterMode, MipmapFilterMode, Sampler, SamplerDescriptor, TextureFormat,
};

use crate::error::Result;
use crate::gpu::{Gpu, Surface2d, TextureSpec, Tracked};

/// Callback after each pass: is told its name, and gives back an encoder to go on with.
pub(crate) type Lap<'a> = &'a mut dyn FnMut(&'static str, CommandEncoder) -> CommandEncoder;

/// Block and reflections of a scene on the device.
#[derive(Debug)]
pub(crate) struct Common {
    pub(crate) block: Tracked<Buffer>,
    pub(crate) reflections: Surface2d,
    /// Levels of the environment that `reflections` shows.
    shown: Vec<Vec<[f32; 3]>>,
}

impl Common {
    /// Bytes on the device.
    pub(crate) const BYTES: u64 = {
        let (mut bytes, mut level) = (size_of::<uniform::Scene>() as u64, 0);
        while level < REFLECTION_LEVELS {
            bytes += (REFLECTION_SIZE[0] as u64 >> level) * (REFLECTION_SIZE[1] as u64 >> level) * 8;
            level += 1;
        }
        bytes
    };

    pub(crate) fn new(gpu: &Gpu) -> Result<Self> {
        let spec = TextureSpec::table("reflections", REFLECTION_SIZE, TextureFormat::Rgba16Float);
        Ok(Self {
            block: gpu.uniform("scene", &<uniform::Scene as bytemuck::Zeroable>::zeroed()),
            reflections: gpu.texture(&TextureSpec { levels: REFLECTION_LEVELS, ..spec })?,
            shown: Vec::new(),
        })
    }

    /// Uploads the reflections of the environment if they are others than before.
    pub(crate) fn show(&mut self, gpu: &Gpu, scene: &Scene) -> Result<()> {
        let levels = scene.environment.reflections();
        if self.shown == levels {
            return Ok(());
        }
        for (pixels, level) in levels.iter().zip(0..) {
            // Half floats hold no more.
            let texels = pixels.iter().flat_map(|[r, g, b]| [*r, *g, *b, 1.0].map(|value| value.min(65_504.0)));
            let texels: Vec<u16> = texels.map(|value| f16::from_f32(value).to_bits()).collect();
            let bytes = bytemuck::cast_slice(&texels);
            gpu.checked(|| gpu.fill_level(&self.reflections.texture, 0, level, bytes))?;
        }
        self.shown = levels.to_vec();
        Ok(())
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
