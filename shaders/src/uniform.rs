//! Uniform blocks, laid out as in WGSL; `tests/layout.rs` holds them to it.

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::bssrdf::Header;

use crate::cpu::Rgb;
use crate::separable::{self, Factors, MAX_TERMS};

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

/// `Stage` of `blur.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Stage {
    /// w_lma pitch² of this stage's a; shape `[l][m]`, rgb.
    pub weights: [[f32; 4]; MAX_TERMS * MAX_TERMS],
    /// (1, 0) or (0, 1).
    pub axis: [i32; 2],
    /// Standard deviation on a flat patch, in pixels.
    pub sigma: f32,
    /// Pixels from one tap to the next on a flat patch.
    pub stride: i32,
    /// Taps to each side on a flat patch.
    pub taps: i32,
    /// Standard deviation of the stage anywhere else, in pixels of the material.
    pub step: f32,
    /// Distance of taps that what is blurred already allows, in pixels of the material.
    pub sparse: f32,
    /// 0 for the first stage.
    pub begun: u32,
}

impl Stage {
    /// The blocks of all stages of a factorised material, along rows and along columns.
    #[must_use]
    pub fn cascade(factors: &Factors) -> Vec<[Self; 2]> {
        let area = factors.header.pitch_mm * factors.header.pitch_mm;
        let terms = factors.detail.terms;
        let stages = separable::Stage::cascade(&factors.sigmas);
        let blocks = stages.iter().enumerate().map(|(a, stage)| {
            let mut weights = [[0.0; 4]; MAX_TERMS * MAX_TERMS];
            for (l, m) in (0..terms).flat_map(|l| (0..terms).map(move |m| (l, m))) {
                let [r, g, b] = factors.weights_of(l, m)[a].map(|weight| weight * area);
                weights[l * MAX_TERMS + m] = [r, g, b, 0.0];
            }
            [[1, 0], [0, 1]].map(|axis| Self {
                weights,
                axis,
                sigma: stage.sigma,
                stride: stage.stride,
                taps: stage.taps,
                step: stage.step,
                sparse: stage.sparse,
                begun: u32::from(a > 0),
            })
        });
        blocks.collect()
    }
}

/// `Domain` of `on_patch.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PatchDomain {
    /// Pixels of the patch.
    pub size: [u32; 2],
    /// 0 clamp, 1 repeat, 2 mirror.
    pub addressing: u32,
    #[doc(hidden)]
    pub pad: u32,
}

impl PatchDomain {
    /// The block for a patch.
    #[must_use]
    pub fn new(header: &Header) -> Self {
        Self { size: [header.width, header.height], addressing: header.addressing.code().into(), pad: 0 }
    }
}

/// `Domain` of `on_screen.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct ScreenDomain {
    /// Texels of the maps.
    pub size: [u32; 2],
    /// Texels that a pixel of the material covers at a distance of 1 mm.
    pub focal_texels: f32,
    /// Distance from the eye to depth 0.
    pub middle_mm: f32,
    /// Pixel of the material.
    pub pitch_mm: f32,
    #[doc(hidden)]
    pub pad: [u32; 3],
}

/// Most taps to one side of `homogeneous.wgsl`, the middle one counted.
pub const MAX_KERNEL: usize = 64;

/// `Stage` of `homogeneous.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Kernel {
    /// Weights at 0, 1, 2 ... pixels to either side; rgb.
    pub kernel: [[f32; 4]; MAX_KERNEL],
    /// (1, 0) or (0, 1).
    pub axis: [i32; 2],
    /// Pixels from one tap to the next.
    pub stride: i32,
    /// Taps to each side.
    pub taps: i32,
    #[doc(hidden)]
    pub sigma: f32,
    #[doc(hidden)]
    pub pad: [u32; 3],
}

impl Kernel {
    /// The blocks along rows and along columns for weights at 0, 1, 2 ... pixels.
    #[must_use]
    pub fn new(weights: &[Rgb]) -> [Self; 2] {
        let mut kernel = [[0.0; 4]; MAX_KERNEL];
        for (block, [r, g, b]) in kernel.iter_mut().zip(weights) {
            *block = [*r, *g, *b, 0.0];
        }
        let taps = i32::try_from(weights.len().clamp(1, MAX_KERNEL) - 1).unwrap_or(0);
        [[1, 0], [0, 1]].map(|axis| Self { kernel, axis, stride: 1, taps, sigma: 1.0, pad: [0; 3] })
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
