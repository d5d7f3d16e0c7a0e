//! Canvases: pictures and surfaces as renderers see them.

use subsurf_runtime::wgpu::{TextureFormat, TextureView};

/// What a frame is drawn to.
pub(crate) struct Canvas<'a> {
    pub(crate) view: &'a TextureView,
    pub(crate) format: TextureFormat,
    pub(crate) size: [u32; 2],
}
