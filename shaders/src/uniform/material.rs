//! Block of a material.

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::bssrdf::BssrdfHeader;

/// Texels to a row of textures that hold plain arrays, the words of a BTF file among them; every GLES 3.0 device has as
/// many.
pub const ROW: u32 = 2_048;

/// `Material` of `material.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Material {
    /// Pixels of the patch, columns and rows.
    pub size: [u32; 2],
    /// 0 clamp, 1 repeat, 2 mirror.
    pub addressing: u32,
    /// R, half the side of the window of neighbours, in pixels.
    pub window_radius: u32,
    /// S, the number of nodes of a profile.
    pub samples: u32,
    /// M, the number of base materials; 0 for per-pixel profiles.
    pub base_materials: u32,
    /// Distance of neighbouring pixels in mm.
    pub pitch_mm: f32,
    /// Radius of the last node in mm.
    pub r_max_mm: f32,
    /// (S − 1) / r_max, in nodes per mm.
    pub nodes_per_mm: f32,
    /// Rows to a layer of plain arrays that have layers.
    pub rows: u32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// Base materials to a column of the texture of their profiles: every GLES 3.0 device has twice as many texels, so that
/// 65,536 profiles of 32 nodes fit beside each other.
pub const BASE_ROWS: u32 = 1_024;

impl Material {
    /// The block for a file's header; layers of plain arrays have `rows` rows.
    #[must_use]
    pub fn new(header: &BssrdfHeader, rows: u32) -> Self {
        Self {
            size: [header.width, header.height],
            addressing: header.addressing.code().into(),
            window_radius: header.window_radius.into(),
            samples: header.samples.into(),
            base_materials: header.base_materials,
            pitch_mm: header.pitch_mm,
            r_max_mm: header.r_max_mm,
            nodes_per_mm: f32::from(header.samples.saturating_sub(1)) / header.r_max_mm,
            rows,
            pad: [0; 2],
        }
    }
}
