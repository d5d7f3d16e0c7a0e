//! Uniform blocks, laid out as in WGSL; `tests/layout.rs` holds them to it.

mod btf;
mod scene;

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::bssrdf::Header;
use subsurf_scene::MAX_LIGHTS;

use crate::cpu::Rgb;
use crate::separable::{self, Factors, MAX_GAUSSIANS, MAX_TERMS};

pub use btf::{BtfBooks, BtfFiltering, BtfImages, BtfTable, BtfTexture, MAX_LEVELS, MAX_RINGS_OF_DIRECTIONS};

/// Texels to a row of textures that hold plain arrays, the words of a BTF file among them; every GLES 3.0 device has as
/// many.
pub const ROW: u32 = 2_048;

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

/// `LightSource` of `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct LightSource {
    /// Of the light's own view; column-major, depth 0 to 1.
    pub clip_from_world: [[f32; 4]; 4],
    /// Unit vector towards the light, or its position in mm.
    pub place: [f32; 3],
    /// 0 for a direction, 1 for a position.
    pub is_local: u32,
    /// Irradiance on a plane that faces it, anywhere, or 1 mm away; linear Rec. 709.
    pub irradiance: [f32; 3],
    /// Cosine of the angle from the axis beyond which there is no light.
    pub cos_outer: f32,
    /// Unit vector along which the light looks.
    pub axis: [f32; 3],
    /// Cosine of the angle from the axis where light begins to fade.
    pub cos_inner: f32,
    /// Distance along the axis from the light to depth 0; 0 for a direction.
    pub middle_mm: f32,
    /// Edge of a texel of its view at depth 0.
    pub texel_mm: f32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// `Scene` of `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Scene {
    /// Column-major; depth 0 to 1.
    pub clip_from_world: [[f32; 4]; 4],
    /// Position of the eye.
    pub eye_mm: [f32; 3],
    /// Multiplies radiance before tone mapping.
    pub exposure: f32,
    /// Unit vector along which the eye looks.
    pub forward: [f32; 3],
    /// Distance along it to depth 0.
    pub middle_mm: f32,
    /// Where depth is 0.
    pub centre_mm: [f32; 3],
    /// Refractive index of the material against air.
    pub eta: f32,
    /// 1 − F_dr from outside.
    pub sky_transmittance: f32,
    /// GGX roughness of the coat, 0 to 1.
    pub roughness: f32,
    /// Number of lights.
    pub lights: u32,
    /// Texels to a row of textures that hold plain arrays.
    pub row: u32,
    /// Box mapping: copies of the patch to a mm.
    pub patches_per_mm: [f32; 2],
    /// Pixel of the material.
    pub pitch_mm: f32,
    /// 0 texture coordinates, 1 box mapping.
    pub is_boxed: u32,
    /// Irradiance of the environment on a normal (x, y, z): coefficients of 1, y, z, x, xy, yz, 3z² − 1, xz, x² − y².
    pub sky: [[f32; 4]; 9],
    /// The lights.
    pub light: [LightSource; MAX_LIGHTS],
}

/// `Which` of `seen.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Which {
    /// Number of the light.
    pub light: u32,
    #[doc(hidden)]
    pub pad: [u32; 3],
}

/// `Through` of `through.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Through {
    /// w_lma pitch², shape `[a][l][m]`, rgb; σ_a in mm in the fourth place.
    pub weights: [[f32; 4]; MAX_GAUSSIANS * MAX_TERMS * MAX_TERMS],
    /// A.
    pub gaussians: u32,
    #[doc(hidden)]
    pub pad: [u32; 3],
}

impl Through {
    /// The block for a factorised material.
    #[must_use]
    pub fn new(factors: &Factors) -> Self {
        let mut weights = [[0.0; 4]; MAX_GAUSSIANS * MAX_TERMS * MAX_TERMS];
        let stages = Stage::cascade(factors);
        for (a, ([rows, _], sigma)) in stages.iter().zip(&factors.sigmas).enumerate() {
            let of_stage = &mut weights[a * rows.weights.len()..][..rows.weights.len()];
            for (to, [r, g, b, _]) in of_stage.iter_mut().zip(&rows.weights) {
                *to = [*r, *g, *b, sigma * factors.header.pitch_mm];
            }
        }
        let gaussians = u32::try_from(stages.len()).unwrap_or(0);
        Self { weights, gaussians, pad: [0; 3] }
    }
}

/// `Splat` of `splat.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Splat {
    /// What softening by k / 2 pixels of the material takes from the light of a sample, as the factor that gives it back.
    pub softened: [[f32; 4]; 8],
    /// From positions relative to the middle of the scene; column-major.
    pub clip_from_centre: [[f32; 4]; 4],
    /// Distances in mm where the ring begins and ends to fade in; twice 0 for the first.
    pub fade_in: [f32; 2],
    /// Likewise out.
    pub fade_out: [f32; 2],
    /// Half the size of something 1 mm large, 1 mm away, in clip space.
    pub focal: [f32; 2],
    /// Distance from the light to depth 0; 0 for a direction.
    pub middle_mm: f32,
    /// Edge of a texel of this level at depth 0.
    pub texel_mm: f32,
    /// Number of the light.
    pub light: u32,
    /// Level of the samples.
    pub level: u32,
    /// Texels to a side of it.
    pub side: u32,
    /// 1 if samples stand for those of the next level that are not smooth.
    pub refines: u32,
    /// Texels of what the eye sees to a texel of the target.
    pub stride: u32,
    /// Pixel of the material.
    pub pitch_mm: f32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// Most rings of `collapse.wgsl`.
pub const MAX_RINGS: usize = 5;

/// `Rings` of `collapse.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Rings {
    /// Number of rings.
    pub count: u32,
    /// Differences of depth count in this, at the finest ring.
    pub near_mm: f32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// `Upsampling` of `upsampling.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Upsampling {
    /// Texels of the maps to a pixel of the picture.
    pub texels_per_pixel: [f32; 2],
    /// Differences of depth count in this.
    pub near_mm: f32,
    #[doc(hidden)]
    pub pad: u32,
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

/// `Domain` of `on_screen.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct ScreenDomain {
    /// Texels of the maps.
    pub size: [u32; 2],
    /// Texels that a pixel of the material covers at a distance of 1 mm.
    pub focal_texels: f32,
    /// Distance from the eye to depth 0.
    pub middle_mm: f32,
    /// Pixel of the material.
    pub pitch_mm: f32,
    /// 1 if taps are shifted from texel to texel.
    pub jitters: u32,
    #[doc(hidden)]
    pub pad: [u32; 2],
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
    /// Taps to each side.
    pub taps: i32,
    #[doc(hidden)]
    pub pad: u32,
}

impl Kernel {
    /// The blocks along rows and along columns for weights at 0, 1, 2 ... pixels, at most [`MAX_KERNEL`] of them.
    #[must_use]
    pub fn new(weights: &[Rgb]) -> [Self; 2] {
        let mut kernel = [[0.0; 4]; MAX_KERNEL];
        for (block, [r, g, b]) in kernel.iter_mut().zip(weights) {
            *block = [*r, *g, *b, 0.0];
        }
        let taps = i32::try_from(weights.len().clamp(1, MAX_KERNEL) - 1).unwrap_or(0);
        [[1, 0], [0, 1]].map(|axis| Self { kernel, axis, taps, pad: 0 })
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
