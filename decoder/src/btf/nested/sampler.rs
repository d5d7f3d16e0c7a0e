//! Importance sampling: lights in proportion to luma of a texel (Havran et al. 2010, section 5.2).
//!
//! dω = dα d(sin β), and luma is linear between nodes of all four axes. So its integral over slices is linear between
//! nodes of α, and over α its inverse is the root of a quadratic; within the slice there, likewise for sin β. Both move
//! without jumps as the random numbers grow.

use super::codebooks::NestedCodebooks;
use super::evaluate::Corner;
use super::piecewise_linear::{Axis, PiecewiseLinear};
use super::scale::{Scale, near};
use super::stage::Stage;
use crate::btf::angle::{atan2, sin_cos};
use crate::btf::coord::LerpCoord;
use crate::btf::grid::{Grid, View};
use core::f32::consts::FRAC_PI_2;

/// Light that was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Unit vector towards it, z ≥ 0.
    pub light: [f32; 3],
    /// Density of directions there, per steradian; above 0.
    pub pdf: f32,
}

/// Sampler of lights for one texel and view.
///
/// The density follows luma of the first stage before it fades out at the horizon. It is exact but for the means of
/// slices, which are rounded and so up to 7 % off, and for 1/32 of the draws along either axis, which fall anywhere.
#[derive(Clone, Copy, Debug)]
pub struct Sampler<'a> {
    stage: &'a Stage<'a>,
    grid: &'a Grid,
    azimuth: [f32; 2],
    /// P2 of the four nodes of view around the view.
    rows: [Row; 4],
    /// Density of α, from −π/2 to π/2, by the integrals over slices.
    alpha: PiecewiseLinear<'a>,
    /// Axis of sin β, for [`Self::beta`].
    beta_axis: &'a Axis,
}

/// A row of P2 with c_P4 c_P3 for [`near`], c_P6 being common to all directions, and the weight of the node of view.
#[derive(Clone, Copy, Debug)]
struct Row {
    p2: u32,
    scale: u32,
    weight: f32,
}

impl<'a> Sampler<'a> {
    pub(crate) fn new(codebooks: &'a NestedCodebooks<'a>, grid: &'a Grid, texel: u32, view: &View) -> Self {
        let (stage, _) = codebooks.stages();
        let (p4, _) = stage.texels.one::<false>(texel, 0);
        let [a, b, c, d] = stage.corners::<false>(p4, Scale::default(), view.phi, view.theta);
        let row = |corner: Corner| {
            let (p2, _) = codebooks.merged(corner.row);
            Row { p2, scale: corner.scale.near_bits(), weight: corner.weight }
        };
        let rows = [row(a), row(b), row(c), row(d)];
        let [alpha_axis, beta_axis] = codebooks.axes();
        let mut alpha = PiecewiseLinear::over(alpha_axis);
        let mut node = 0_u32;
        for integrals in alpha.fours() {
            for Row { p2, scale, weight } in rows {
                for (integral, c2) in integrals.iter_mut().zip(stage.p2.four_near(p2, node)) {
                    *integral += weight * near(scale.wrapping_add(c2));
                }
            }
            node = node.wrapping_add(4);
        }
        alpha.integrate();
        Self { stage, grid, azimuth: view.azimuth, rows, alpha, beta_axis }
    }

    /// Density of sin β, from −1 to 1, by luma between the slices at a node of α and the next.
    #[inline(always)]
    fn beta(&self, alpha: u32, weight: f32) -> PiecewiseLinear<'a> {
        // First bytes of slices, and what their codes are multiplied by.
        let (mut lows, mut highs) = ([(0, 0.0); 4], [(0, 0.0); 4]);
        for ((low, high), row) in lows.iter_mut().zip(&mut highs).zip(&self.rows) {
            let part = |(slice, c2): (u32, Scale)| {
                let start = self.stage.start(slice);
                let scale = row.scale.wrapping_add(c2.near_bits()).wrapping_add(self.stage.near_exponent(start));
                (start, row.weight * near(scale))
            };
            let [first, second] = self.stage.p2.two::<false>(row.p2, alpha);
            (*low, *high) = (part(first), part(second));
        }
        let mut density = PiecewiseLinear::over(self.beta_axis);
        // Indices were checked: it does not end early.
        let _ = self.fill(&mut density, [&lows, &highs], weight);
        density.integrate();
        density
    }

    /// Adds up slices, interpolated in α. `None` if bytes are missing.
    #[inline(always)]
    fn fill(&self, density: &mut PiecewiseLinear<'_>, slices: [&[(u32, f32); 4]; 2], weight: f32) -> Option<()> {
        let mut node = 0_u32;
        for values in density.fours() {
            let mut sums = [[0.0; 4]; 2];
            for (sums, parts) in sums.iter_mut().zip(slices) {
                for (start, factor) in parts {
                    let codes = self.stage.four(start.wrapping_add(node))?;
                    for (sum, code) in sums.iter_mut().zip(codes) {
                        *sum += factor * f32::from(*code);
                    }
                }
            }
            let [lows, highs] = sums;
            for (value, (low, high)) in values.iter_mut().zip(lows.into_iter().zip(highs)) {
                *value = low + weight * (high - low);
            }
            node = node.wrapping_add(4);
        }
        Some(())
    }

    /// Light for two random numbers, 0 to 1: α grows with the first, sin β with the second, and none of them jumps.
    #[must_use]
    pub fn sample(&self, random: [f32; 2]) -> Sample {
        #[allow(clippy::manual_clamp, reason = "NaN is 0")]
        let [first, second] = random.map(|number| number.max(0.0).min(1.0));
        let alpha = self.alpha.draw(first);
        let beta = self.beta(alpha.node, alpha.weight).draw(second);
        let light = Grid::light(sin_cos(alpha.at - FRAC_PI_2), beta.at - 1.0, self.azimuth);
        Sample { light, pdf: alpha.density * beta.density }
    }

    /// Density with which [`Self::sample`] draws a light, per steradian; 0 below the horizon.
    #[must_use]
    pub fn pdf(&self, light: [f32; 3]) -> f32 {
        let [_, _, z] = light;
        if z >= 0.0 {
            let [forward, sin_beta] = Grid::in_frame(light, self.azimuth);
            let alpha = atan2(forward, z);
            let LerpCoord { nodes: [node, _], weight } = self.grid.alpha(alpha);
            self.alpha.at(alpha + FRAC_PI_2) * self.beta(node, weight).at(sin_beta + 1.0)
        } else {
            0.0
        }
    }
}
