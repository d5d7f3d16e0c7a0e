//! Lights in proportion to what a texel shows of them (section 5.2 of the paper).
//!
//! dω = dα d(sin β), and luma is linear between nodes of all four axes. So its integral over slices is linear between
//! nodes of α, and over α its inverse is the root of a quadratic; within the slice there, likewise for sin β. Both move
//! without jumps as the random numbers grow.

use super::chain::Corner;
use super::line::{Line, Values, ZEROS};
use super::reader::Nested;
use super::stage::{Scale, Stage, near};
use crate::btf::angle::{atan2, sin_cos};
use crate::btf::grid::{Grid, Place, View};
use core::f32::consts::FRAC_PI_2;

/// A light that was drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Unit vector towards it, z ≥ 0.
    pub light: [f32; 3],
    /// Density of directions there, per steradian; above 0.
    pub pdf: f32,
}

/// Draws lights for one texel and view.
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
    /// Integrals over the slices at nodes of α.
    slices: Values,
}

/// A row of P2 with c_P4 c_P3, c_P6 being common to all directions, and the weight of the node of view.
#[derive(Clone, Copy, Debug)]
struct Row {
    p2: u32,
    scale: Scale,
    weight: f32,
}

impl<'a> Sampler<'a> {
    pub(crate) fn new(nested: &'a Nested<'a>, grid: &'a Grid, texel: u32, view: &View) -> Self {
        let (stage, _) = nested.stages();
        let (p4, _) = stage.texels.one::<false>(texel, 0);
        let [a, b, c, d] = stage.corners::<false>(p4, Scale::default(), view.phi, view.theta);
        let row = |corner: Corner| {
            let (p2, _) = nested.merged(corner.row);
            Row { p2, scale: corner.scale, weight: corner.weight }
        };
        let rows = [row(a), row(b), row(c), row(d)];
        let mut slices = ZEROS;
        for Row { p2, scale, weight } in rows {
            let (mut at, of_row) = (0, scale.near_bits());
            // An odd number of nodes has one too many, which is not looked at.
            let (pairs, _) = slices.as_flattened_mut().as_chunks_mut::<2>();
            for [first, second] in pairs.iter_mut().take(usize::from(grid.n_alpha).div_ceil(2)) {
                let [(low, c_low), (high, c_high)] = stage.p2.two_near(p2, at);
                let integral = |slice, c2: u32| near(of_row.wrapping_add(c2).wrapping_sub(stage.mean_bits(slice)));
                *first += weight * integral(low, c_low);
                *second += weight * integral(high, c_high);
                at = at.wrapping_add(stage.p2.before(2));
            }
        }
        Self { stage, grid, azimuth: view.azimuth, rows, slices }
    }

    #[inline]
    fn over_alpha(&self) -> Line<'_> {
        Line::new(&self.slices, self.grid.n_alpha, self.grid.alpha_max, FRAC_PI_2)
    }

    /// Over sin β, for the values of a slice.
    #[inline]
    fn over_beta<'v>(&self, values: &'v Values) -> Line<'v> {
        Line::new(values, self.grid.n_beta, self.grid.sin_beta_max, 1.0)
    }

    /// Luma at nodes of sin β, in the slice at α.
    #[inline]
    fn slice(&self, alpha: f32) -> Values {
        let Place { nodes: [first, _], weight } = self.grid.alpha(alpha);
        let at = self.stage.p2.before(first);
        let mut parts = [[(0, 0.0); 2]; 4];
        for (part, row) in parts.iter_mut().zip(&self.rows) {
            let [(low, c_low), (high, c_high)] = self.stage.p2.two::<false>(row.p2, at);
            *part = [
                (low, (1.0 - weight) * (row.weight * row.scale.times(c_low).value())),
                (high, weight * (row.weight * row.scale.times(c_high).value())),
            ];
        }
        let mut values = ZEROS;
        for (values, node) in values.iter_mut().zip((0..u32::from(self.grid.n_beta)).step_by(4)) {
            let mut sums = [0.0; 4];
            for (slice, weight) in parts.as_flattened() {
                // Beyond n_β are others, which are not looked at.
                let codes = self.stage.slice_part(*slice, node);
                for (sum, code) in sums.iter_mut().zip(codes) {
                    *sum += weight * f32::from(code);
                }
            }
            *values = sums;
        }
        values
    }

    /// A light for two random numbers, 0 to 1: α grows with the first, sin β with the second, and none of them jumps.
    #[must_use]
    pub fn sample(&self, random: [f32; 2]) -> Sample {
        let [first, second] = random;
        // NaN is 0.
        let alpha = self.over_alpha().draw(first.max(0.0).min(1.0));
        let angle = alpha.at - FRAC_PI_2;
        let beta = self.over_beta(&self.slice(angle)).draw(second.max(0.0).min(1.0));
        let light = Grid::light(sin_cos(angle), beta.at - 1.0, self.azimuth);
        Sample { light, pdf: alpha.density * beta.density }
    }

    /// The density with which [`Self::sample`] draws a light, per steradian; 0 below the horizon.
    #[must_use]
    pub fn pdf(&self, light: [f32; 3]) -> f32 {
        let [_, _, z] = light;
        if z >= 0.0 {
            let [forward, sin_beta] = Grid::in_frame(light, self.azimuth);
            let alpha = atan2(forward, z);
            self.over_alpha().at(alpha + FRAC_PI_2) * self.over_beta(&self.slice(alpha)).at(sin_beta + 1.0)
        } else {
            0.0
        }
    }
}
