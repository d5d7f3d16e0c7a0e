//! Options of renderers.

use wgpu::{Color, TextureFormat};

use crate::technique::BtfOptions;

/// Budget of a renderer, and what it draws to.
#[derive(Clone, Copy, Debug)]
pub struct RuntimeOptions {
    /// Most bytes on the device, those of meshes and materials included; no limit if `None`. The target is the
    /// caller's, and what [`crate::Renderer::picture`] draws to and reads back is not counted.
    pub budget_bytes: Option<u64>,
    /// Format of the picture. Where it is one of sRGB, the device encodes; else the shader does.
    pub format: TextureFormat,
    /// Samples to a pixel of the picture, 1 or 4.
    pub samples: u32,
    /// Texels to a side of what each light sees: a power of two, at least 128.
    pub light_texels: u32,
    /// Filtering and sampling of BTFs.
    pub btf: BtfOptions,
    /// Colour behind the mesh, in the values that the target takes.
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
            btf: BtfOptions::default(),
            background: Color { r: grey, g: grey, b: grey, a: 1.0 },
        }
    }
}

/// Display value of red, green and blue of the usual background, 0 to 255: a dark grey.
pub const BACKGROUND: u8 = 46;
