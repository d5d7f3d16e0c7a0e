//! Blocks of LinSSS.

use bytemuck::{Pod, Zeroable};

/// Most Gaussians: `MAX_LINSSS_GAUSSIANS` of `linsss.wgsl`.
pub const MAX_LINSSS_GAUSSIANS: usize = 8;

/// `Linsss` of `linsss.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Linsss {
    /// Standard deviations σ_h by channel in mm.
    pub sigmas_mm: [[f32; 4]; MAX_LINSSS_GAUSSIANS],
    /// H, 1 to 8.
    pub gaussians: u32,
    /// 1 if layers are W_h, 0 if they are W_h + G_h * W_h.
    pub is_exact: u32,
    /// Number of the Gaussian whose weighted light is drawn.
    pub turn: u32,
    #[doc(hidden)]
    pub pad: u32,
}

/// `LinsssStage` of `linsss_stage.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct LinsssStage {
    /// Standard deviations by channel in mm.
    pub sigma_mm: [f32; 4],
    /// Axis of the blur, (1, 0) or (0, 1).
    pub axis: [i32; 2],
    /// Texels of the maps that hold anything, columns and rows.
    pub size: [i32; 2],
    /// Texels of the maps that 1 mm covers at a distance of 1 mm, or at any, along rows and columns.
    pub focal_texels: [f32; 2],
    /// Distance from the eye to depth 0 in mm; 1 where the projection is parallel.
    pub middle_mm: f32,
    /// 1 in perspective; 0 where the projection is parallel.
    pub perspective: f32,
    /// Levels of the pyramid.
    pub levels: u32,
    /// Level that is drawn.
    pub level: u32,
    /// Texels of the maps, of which the first hold something, columns and rows.
    pub most: [i32; 2],
}
