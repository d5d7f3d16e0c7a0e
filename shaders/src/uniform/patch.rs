//! Blocks of passes on flat patches.

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::rgb::Rgb;

/// `PatchRegion` of `gather.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PatchRegion {
    /// Pixel of the patch, column and row, that the first texel of the target shows.
    pub origin: [u32; 2],
    #[doc(hidden)]
    pub pad: [u32; 2],
}

/// `PatchDomain` of `domain_patch.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct PatchDomain {
    /// Pixels of the patch, columns and rows.
    pub size: [u32; 2],
    /// 0 clamp, 1 repeat, 2 mirror.
    pub addressing: u32,
    #[doc(hidden)]
    pub pad: u32,
}

impl PatchDomain {
    /// Block for the patch of a file.
    #[must_use]
    pub fn new(header: &BssrdfHeader) -> Self {
        Self { size: [header.width, header.height], addressing: header.addressing.code().into(), pad: 0 }
    }
}

/// Largest number of taps to one side of `homogeneous.wgsl`, the middle one counted.
pub const MAX_KERNEL: usize = 64;

/// `Kernel` of `homogeneous.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Kernel {
    /// Weights at 0, 1, 2 ... pixels to either side, linear Rec. 709.
    pub weights: [[f32; 4]; MAX_KERNEL],
    /// Axis of the blur, (1, 0) or (0, 1).
    pub axis: [i32; 2],
    /// Number of taps to each side.
    pub taps: i32,
    #[doc(hidden)]
    pub pad: u32,
}

impl Kernel {
    /// Blocks along rows and along columns for a kernel with weights at 0, 1, 2 ... pixels, at most [`MAX_KERNEL`] of them.
    #[must_use]
    pub fn new(kernel: &[Rgb]) -> [Self; 2] {
        let mut weights = [[0.0; 4]; MAX_KERNEL];
        for (block, [r, g, b]) in weights.iter_mut().zip(kernel) {
            *block = [*r, *g, *b, 0.0];
        }
        let taps = i32::try_from(kernel.len().clamp(1, MAX_KERNEL) - 1).unwrap_or(0);
        [[1, 0], [0, 1]].map(|axis| Self { weights, axis, taps, pad: 0 })
    }
}

/// `Frame` of `present.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Frame {
    /// Pixels of the picture, columns and rows.
    pub size: [u32; 2],
    /// Texels of the patch, columns and rows.
    pub texels: [u32; 2],
    /// Factor of the exitance before tone mapping.
    pub exposure: f32,
    #[doc(hidden)]
    pub pad: [f32; 3],
}
