//! Options of renderers.

use wgpu::{Color, TextureFormat};

use crate::gpu::DEPTH;
use crate::technique::{BtfOptions, DepthFormat};

/// Budget of a renderer, and what it draws to.
#[derive(Clone, Copy, Debug)]
pub struct RuntimeOptions {
    /// Most bytes on the device, those of meshes and materials included; no limit if `None`. What frames are drawn to is the
    /// host's, and counts only if it is a [`crate::PictureTarget`].
    pub budget_bytes: Option<u64>,
    /// Format of colour. Where it is one of sRGB, the device encodes; else the shader does, after tone mapping.
    pub format: TextureFormat,
    /// Samples to a pixel of colour and depth, 1 or 4.
    pub samples: u32,
    /// Format of depth, and its direction.
    pub depth: DepthFormat,
    /// Whether light is tone-mapped to 0 to 1 (Khronos PBR Neutral); else colour is linear radiance times exposure, Rec. 709.
    pub tone_mapping: bool,
    /// Whether lights may have shadow maps of the host's own: passes that look them up are larger.
    pub host_shadow_maps: bool,
    /// Texels to a side of what each light sees: a power of two, at least 128. Fewer where the textures of a device have no room for
    /// as many beside and below each other: those of 2,048 texels to a side hold eight views of 512.
    pub light_texels: u32,
    /// Most bytes of the maps of blurs on the screen for each pixel of the picture, more than 0: maps become coarser until they keep to them, but
    /// those of the separable technique have 256 × 256 texels at least.
    pub map_bytes_per_pixel: f32,
    /// Whether a third of the taps of separable kernels are turned, by an angle of each pixel's own: faint noise in place of bands and of the
    /// axes of the kernel (Jimenez et al. 2015, supplement, figures S.6 and S.7).
    pub jittered_taps: bool,
    /// Most objects of a frame.
    pub objects: u32,
    /// Filtering and sampling of BTFs.
    pub btf: BtfOptions,
}

impl Default for RuntimeOptions {
    fn default() -> Self {
        Self {
            budget_bytes: None,
            format: TextureFormat::Rgba8Unorm,
            samples: 1,
            depth: DepthFormat { format: DEPTH, is_reversed: false },
            tone_mapping: true,
            host_shadow_maps: false,
            light_texels: 512,
            map_bytes_per_pixel: 8.75,
            jittered_taps: true,
            objects: 16,
            btf: BtfOptions::default(),
        }
    }
}

/// Display value of red, green and blue of the usual background, 0 to 255: a dark grey.
pub const BACKGROUND: u8 = 46;

/// The usual background as a target takes it that does not encode.
pub const BACKGROUND_COLOUR: Color = {
    let grey = BACKGROUND as f64 / 255.0;
    Color { r: grey, g: grey, b: grey, a: 1.0 }
};
