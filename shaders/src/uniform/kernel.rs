//! Blocks of separable kernels.

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::Kernel;

/// Most taps of one side with the centre.
const SIDE: usize = 33;

/// `KernelTerm` of `kernel.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct KernelTerm {
    /// Weights w_i of the taps of one side, from the centre on, linear Rec. 709; o_i in mm in the fourth place.
    pub taps: [[f32; 4]; SIDE],
    /// Sign s, −1 or 1, linear Rec. 709.
    pub sign: [f32; 4],
    /// Axis of the blur, (1, 0) or (0, 1).
    pub axis: [i32; 2],
    /// Taps of one side with the centre, 3 to 33.
    pub side: u32,
    /// 1 / (2 τ_max) in mm⁻².
    pub falloff: f32,
}

impl KernelTerm {
    /// Blocks of all terms, along rows and along columns; shape `[term][2]`.
    #[must_use]
    pub fn of(kernel: &Kernel<'_>) -> Vec<[Self; 2]> {
        let header = kernel.header();
        let terms = (0..header.terms.into()).map(|term| {
            let mut taps = [[0.0; 4]; SIDE];
            for (tap, (to, offset)) in taps.iter_mut().zip(kernel.offsets().iter()).enumerate() {
                let [r, g, b] = kernel.weight(term, tap);
                *to = [r, g, b, offset];
            }
            let [r, g, b] = kernel.sign(term);
            [[1, 0], [0, 1]].map(|axis| Self {
                taps,
                sign: [r, g, b, 0.0],
                axis,
                side: u32::try_from(header.side()).unwrap_or(0),
                falloff: 0.5 / header.depth_variance,
            })
        });
        terms.collect()
    }
}

/// `KernelProfile` of `kernel_profile.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct KernelProfile {
    /// Reflectance ‖R_d‖₁, 0 to 1, linear Rec. 709.
    pub reflectance: [f32; 4],
    /// Distance in mm beyond which nothing scatters.
    pub radius_mm: f32,
    /// Number of the last node of the tail.
    pub last_node: u32,
    /// Standard deviation in mm of light that spreads on its way through thin parts.
    pub spread_mm: f32,
    #[doc(hidden)]
    pub pad: u32,
}

impl KernelProfile {
    /// Block of a kernel.
    #[must_use]
    pub fn new(kernel: &Kernel<'_>) -> Self {
        let (header, [r, g, b]) = (kernel.header(), kernel.reflectance());
        Self {
            reflectance: [r, g, b, 0.0],
            radius_mm: header.radius_mm,
            last_node: u32::from(header.tail_nodes) - 1,
            spread_mm: header.depth_variance.sqrt(),
            pad: 0,
        }
    }
}
