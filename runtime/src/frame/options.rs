//! What a renderer may use and what it draws to.

use wgpu::{Color, TextureFormat};

use crate::technique::BtfOptions;

/// What a renderer may use and what it draws to.
#[derive(Clone, Copy, Debug)]
pub struct RuntimeOptions {
    /// Most bytes on the device, those of meshes and materials included; no limit if there is none. The target is the
    /// caller's, and what [`Renderer::picture`] draws to and reads back is not counted.
    pub budget_bytes: Option<u64>,
    /// Format of the picture. Where it is one of sRGB, the device encodes; else the shader does.
    pub format: TextureFormat,
    /// Samples to a pixel, 1 or 4.
    pub samples: u32,
    /// Texels to a side of what each light sees: a power of two, at least 128.
    pub light_texels: u32,
    /// Whether taps of [`Technique::Separable`] are shifted from pixel to pixel: grain instead of bands, where light changes
    /// much within the reach of scattering.
    pub jitters: bool,
    /// How BTFs are looked up.
    pub btf: BtfOptions,
    /// Behind the mesh, as the target takes it.
    pub background: Color,
}

impl Default for RuntimeOptions {
    fn default() -> Self {
        let grey = f64::from(BACKGROUND) / 255.0;
        Self {
            budget_bytes: None,
            format: TextureFormat::Rgba8Unorm,
            samples: 1,
            light_texels: 512,
            jitters: false,
            btf: BtfOptions::default(),
            background: Color { r: grey, g: grey, b: grey, a: 1.0 },
        }
    }
}

/// Dark grey, as 8-bit display value.
pub const BACKGROUND: u8 = 46;
