//! Blocks of separable blurs and of what is put together from them.

use bytemuck::{Pod, Zeroable};
use subsurf_decoder::bssrdf::basis::{MAX_GAUSSIANS, MAX_TERMS};

use crate::separable::BasisNumbers;

/// `BlurStage` of `blur.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct BlurStage {
    /// Weights w_lma of the a of this stage; shape `[l][m]`, linear Rec. 709.
    pub weights: [[f32; 4]; MAX_TERMS * MAX_TERMS],
    /// Axis of the blur, (1, 0) or (0, 1); in a volume also (0, 0), across slices.
    pub axis: [i32; 2],
    /// Standard deviation on a flat patch in pixels, in a volume in cells.
    pub sigma: f32,
    /// Distance of taps on a flat patch in pixels.
    pub stride: i32,
    /// Number of taps to each side on a flat patch or in a volume.
    pub taps: i32,
    /// Standard deviation of the stage on the screen, in pixels of the material; in a volume, sum of the weights of all taps.
    pub step: f32,
    /// Distance of taps that the blur so far allows on the screen, in pixels of the material.
    pub sparse: f32,
    /// 1 if there is a sum of earlier stages, 0 for the first.
    pub has_sum: u32,
}

impl BlurStage {
    /// Blocks of all stages for the basis of a material, along rows and along columns; shape `[a][2]`.
    #[must_use]
    pub fn cascade(basis: &BasisNumbers) -> Vec<[Self; 2]> {
        let terms = basis.size().terms;
        let cascade = basis.cascade();
        let blocks = cascade.stages().iter().enumerate().map(|(a, stage)| {
            let mut weights = [[0.0; 4]; MAX_TERMS * MAX_TERMS];
            for (l, m) in (0..terms).flat_map(|l| (0..terms).map(move |m| (l, m))) {
                let [r, g, b] = basis.weights_of(l, m)[a];
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
                has_sum: u32::from(a > 0),
            })
        });
        blocks.collect()
    }
}

/// Most taps to one side on the screen: `MOST_TAPS` of `domain_screen.wgsl`.
pub const MOST_TAPS: f32 = 16.0;

impl BlurStage {
    /// Blocks of this stage in a volume, along x, y and z: weights times `gain`, a standard deviation in cells, above 0.
    #[must_use]
    pub fn in_volume(&self, gain: f32, sigma: f32, has_sum: bool) -> [Self; 3] {
        let weights = self.weights.map(|weight| weight.map(|value| gain * value));
        #[allow(clippy::cast_possible_truncation, reason = "a few dozen")]
        let taps = (3.2 * sigma).ceil() as i32;
        #[allow(clippy::cast_precision_loss, reason = "a few dozen")]
        let step = (-taps..=taps).map(|k| (-0.5 * (k as f32 / sigma).powi(2)).exp()).sum();
        [[1, 0], [0, 1], [0, 0]].map(|axis| Self {
            weights,
            axis,
            sigma,
            taps,
            step,
            has_sum: u32::from(has_sum),
            ..*self
        })
    }

    /// Taps to each side on the screen where a pixel of the material covers so many texels: `taps_at` of `domain_screen.wgsl`.
    #[must_use]
    pub fn screen_taps(&self, texels_per_pixel: f32) -> u32 {
        let sparse = (self.sparse * texels_per_pixel).floor().max(1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let taps = (3.2 * self.step * texels_per_pixel / sparse).ceil().clamp(1.0, MOST_TAPS) as u32;
        taps
    }
}

/// `ScreenDomain` of `screen.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct ScreenDomain {
    /// Texels of the maps, columns and rows.
    pub size: [u32; 2],
    /// Texels that the pitch of the material covers at a distance of 1 mm, or at any, along rows and columns.
    pub focal_texels: [f32; 2],
    /// Distance from the eye to depth 0 in mm; 1 where the projection is parallel.
    pub middle_mm: f32,
    /// Pitch of the pixels of the material in mm.
    pub pitch_mm: f32,
    /// 1 in perspective, where things further away are smaller; 0 where the projection is parallel.
    pub perspective: f32,
    /// 1 if a third of the taps of a separable kernel are turned, by an angle of each texel's own; not looked at by cascades.
    pub is_jittered: u32,
}

/// `Transmission` of `transmission.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Transmission {
    /// Weights w_lma, shape `[a][l][m]`, linear Rec. 709; σ_a in mm in the fourth channel.
    pub weights: [[f32; 4]; MAX_GAUSSIANS * MAX_TERMS * MAX_TERMS],
    /// A, the number of Gaussians.
    pub gaussians: u32,
    #[doc(hidden)]
    pub pad: [u32; 3],
}

impl Transmission {
    /// Block for the basis of a material.
    #[must_use]
    pub fn new(basis: &BasisNumbers) -> Self {
        let mut weights = [[0.0; 4]; MAX_GAUSSIANS * MAX_TERMS * MAX_TERMS];
        let stages = BlurStage::cascade(basis);
        for (a, ([rows, _], sigma)) in stages.iter().zip(basis.sigmas()).enumerate() {
            let of_stage = &mut weights[a * rows.weights.len()..][..rows.weights.len()];
            for (to, [r, g, b, _]) in of_stage.iter_mut().zip(&rows.weights) {
                *to = [*r, *g, *b, sigma * basis.header().pitch_mm];
            }
        }
        let gaussians = u32::try_from(stages.len()).unwrap_or(0);
        Self { weights, gaussians, pad: [0; 3] }
    }
}

/// `Upsampling` of `upsampling.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Upsampling {
    /// Texels of the maps to a pixel of the picture, along rows and columns.
    pub texels_per_pixel: [f32; 2],
    /// Pixel of the target where the first texel of the maps lies, from the left and from the top.
    pub origin: [f32; 2],
    /// Difference of depth in mm by which the weight of a texel falls to a half.
    pub near_mm: f32,
    #[doc(hidden)]
    pub pad: u32,
    /// Last column and row of the maps that hold anything.
    pub last: [i32; 2],
}
