//! Uniform blocks, laid out as in WGSL; `tests/layout.rs` holds them to it.

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::bssrdf::Header;

use crate::separable::Factors;

/// `Material` of `material.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Material {
    /// Pixels of the patch.
    pub size: [u32; 2],
    /// 0 clamp, 1 repeat, 2 mirror.
    pub addressing: u32,
    /// R in pixels.
    pub window_radius: u32,
    /// S.
    pub samples: u32,
    /// M; 0 for per-pixel profiles.
    pub base_materials: u32,
    /// Distance of neighbouring pixels.
    pub pitch_mm: f32,
    /// Radius of the last node.
    pub r_max_mm: f32,
    /// (S − 1) / r_max, in nodes per mm.
    pub nodes_per_mm: f32,
    /// Base materials to a column of their texture.
    pub base_rows: u32,
    /// Texels to a row of textures that hold plain arrays.
    pub row: u32,
    /// Rows to a layer of one that has layers.
    pub rows: u32,
}

/// Base materials to a column of the texture of their profiles: every GLES 3.0 device has twice as many texels, so that
/// 65,536 profiles of 32 nodes fit beside each other.
pub const BASE_ROWS: u32 = 1_024;

impl Material {
    /// The block for a file's header; plain arrays have layers of `layer` texels.
    #[must_use]
    pub fn new(header: &Header, layer: [u32; 2]) -> Self {
        Self {
            size: [header.width, header.height],
            addressing: header.addressing.code().into(),
            window_radius: header.window_radius.into(),
            samples: header.samples.into(),
            base_materials: header.base_materials,
            pitch_mm: header.pitch_mm,
            r_max_mm: header.r_max_mm,
            nodes_per_mm: f32::from(header.samples.saturating_sub(1)) / header.r_max_mm,
            base_rows: BASE_ROWS,
            row: layer[0],
            rows: layer[1],
        }
    }
}

/// `View` of `gather.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct View {
    /// Pixel of the patch that the target's first texel shows.
    pub origin: [u32; 2],
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// `Surface` of `surface_gather.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct Surface {
    /// Lowest corner of the grid.
    pub origin_mm: [f32; 3],
    /// Edge of a cell.
    pub cell_mm: f32,
    /// Cells in x, y and z.
    pub cells: [u32; 3],
    /// Number of points.
    pub points: u32,
}

/// `Light` of `irradiance.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Light {
    /// Unit vector towards the light.
    pub direction: [f32; 3],
    #[doc(hidden)]
    pub pad_0: f32,
    /// Irradiance on a plane that faces the light, linear Rec. 709.
    pub irradiance: [f32; 3],
    #[doc(hidden)]
    pub pad_1: f32,
    /// Irradiance from all around, linear Rec. 709.
    pub sky: [f32; 3],
    /// 1 − F_dr from outside: what of the sky's light enters.
    pub sky_transmittance: f32,
    /// Refractive index of the material against air.
    pub eta: f32,
    #[doc(hidden)]
    pub pad_2: [f32; 3],
}

/// `Camera` of `shade.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Camera {
    /// Column-major; depth 0 to 1.
    pub clip_from_world: [[f32; 4]; 4],
    /// Position of the eye.
    pub eye_mm: [f32; 3],
    /// Multiplies radiance before tone mapping.
    pub exposure: f32,
    /// 1 / (1 − F_dr) from outside.
    pub exit_scale: f32,
    /// Refractive index of the material against air.
    pub eta: f32,
    /// Texels to a row of the exitance texture.
    pub row: u32,
    #[doc(hidden)]
    pub pad_0: u32,
    /// Radiance from all around, which the surface reflects, linear Rec. 709.
    pub sky: [f32; 3],
    #[doc(hidden)]
    pub pad_1: u32,
}

/// `Term` of `weigh.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Term {
    /// l.
    pub layer: u32,
    #[doc(hidden)]
    pub pad: [u32; 3],
}

/// `Blur` of `blur.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Blur {
    /// Pixels of the patch.
    pub size: [u32; 2],
    /// (1, 0) or (0, 1).
    pub axis: [i32; 2],
    /// Standard deviation in pixels.
    pub sigma: f32,
    /// Pixels to both sides.
    pub reach: i32,
    /// 0 clamp, 1 repeat, 2 mirror.
    pub addressing: u32,
    #[doc(hidden)]
    pub pad: u32,
}

impl Blur {
    /// The block for a patch, a width and an axis.
    #[must_use]
    pub fn new(header: &Header, sigma: f32, axis: [i32; 2]) -> Self {
        let size = [header.width, header.height];
        Self { size, axis, sigma, reach: reach(sigma), addressing: header.addressing.code().into(), pad: 0 }
    }
}

/// Pixels to both sides beyond which a Gaussian is nothing.
#[must_use]
pub fn reach(sigma: f32) -> i32 {
    #[allow(clippy::cast_possible_truncation, reason = "saturates, and windows are small")]
    let reach = (4.0 * sigma).ceil() as i32;
    reach
}

/// Most weights that `combine.wgsl` takes.
pub const MAX_WEIGHTS: usize = 128;

/// `Combine` of `combine.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Combine {
    /// w_lma pitch².
    pub weights: [[f32; 4]; MAX_WEIGHTS],
    /// L.
    pub terms: u32,
    /// A.
    pub gaussians: u32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

impl Combine {
    /// The block for a factorised material.
    #[must_use]
    pub fn new(factors: &Factors) -> Self {
        let small = |n: usize| u32::try_from(n).unwrap_or(0);
        let area = factors.header.pitch_mm * factors.header.pitch_mm;
        let mut weights = [[0.0; 4]; MAX_WEIGHTS];
        for (block, [r, g, b]) in weights.iter_mut().zip(&factors.weights) {
            *block = [r * area, g * area, b * area, 0.0];
        }
        Self { weights, terms: small(factors.detail.terms), gaussians: small(factors.detail.gaussians), pad: [0; 2] }
    }
}

/// `Frame` of `present.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Frame {
    /// Pixels of the picture.
    pub size: [u32; 2],
    /// Texels of the patch.
    pub texels: [u32; 2],
    /// Multiplies exitance before tone mapping.
    pub exposure: f32,
    #[doc(hidden)]
    pub pad: [f32; 3],
}
