//! Blocks of translucent shadow maps and splats.

use bytemuck::{Pod, Zeroable};

/// `TsmLight` of `tsm.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct TsmLight {
    /// Number of the light, from 0.
    pub light: u32,
    /// Number of the group whose light the coarser levels have.
    pub group: f32,
    /// Level that is made from the one before, from 1 on; 0 for the finest.
    pub level: u32,
    #[doc(hidden)]
    pub pad: u32,
}

/// `Splat` of `splat.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Splat {
    /// Factor that gives back the light that softening by k / 2 pixels of the material takes from a sample; shape `[k]`, linear
    /// Rec. 709.
    pub softening_gain: [[f32; 4]; 8],
    /// Projection of positions relative to the middle of the scene; column-major, depth 0 to 1.
    pub clip_from_centre: [[f32; 4]; 4],
    /// Distances in mm where the ring begins and ends to fade in; both 0 for the first.
    pub fade_in: [f32; 2],
    /// Distances in mm where it begins and ends to fade out.
    pub fade_out: [f32; 2],
    /// Distance from the light to depth 0 in mm; 0 for a direction.
    pub middle_mm: f32,
    /// Edge of a texel of this level at depth 0, in mm.
    pub texel_mm: f32,
    /// Number of the tile, from 0.
    pub tile: u32,
    /// Mipmap level of the samples.
    pub level: u32,
    /// Texels to a side of that level.
    pub side: u32,
    /// 0 for samples of the level that are smooth, 1 for those whose parent in the next level is not.
    pub refines: u32,
    /// Texels of the G-buffer to a side of a texel of the target.
    pub stride: u32,
    /// Pitch of the pixels of the material in mm.
    pub pitch_mm: f32,
    /// Number of the group whose light is spread.
    pub group: f32,
    /// Tiles in a row of the translucent shadow maps.
    pub columns: u32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// Largest number of rings of `splat_resolve.wgsl`.
pub const MAX_RINGS: usize = 5;

/// `SplatRings` of `splat_resolve.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct SplatRings {
    /// Number of rings.
    pub count: u32,
    /// Difference of depth in mm by which the weight of a texel of the finest ring falls to a half.
    pub near_mm: f32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}
