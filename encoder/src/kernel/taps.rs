//! Taps: where kernels are sampled, and what each sample stands for.

use super::grid::{Grid, Separable};
use super::profile::Radial;

/// Cells in which the energy along an axis is looked up.
const CELLS: usize = 4_096;

/// Power of the energy along an axis that the density of taps follows: 1 would leave far light to a tap or two, 0 spread them
/// evenly.
const POWER: f64 = 0.5;

/// Taps of one side, shared by channels and terms.
pub(super) struct Taps {
    /// Edges in mm between the intervals that taps stand for; the first, 0, is the middle of the first tap's.
    edges: Vec<f64>,
    /// Offsets in mm; the first is 0.
    pub(super) offsets: Vec<f64>,
}

impl Taps {
    /// `count` taps, an odd number, over both sides, as dense as the square root of the mean energy of the channels' light along
    /// an axis; each at the mean distance of the light in its interval.
    pub(super) fn new(channels: &[Radial; 3], radius_mm: f64, count: usize) -> Self {
        let grid = Grid::new(radius_mm, CELLS);
        let mut density = vec![0.0; CELLS];
        for radial in channels {
            let energy = radial.energy();
            for (sum, mean) in density.iter_mut().zip(grid.means(|x| radial.along_axis_to(x) / energy)) {
                *sum += mean.max(0.0);
            }
        }
        let widths = grid.widths();
        let mut sum = 0.0;
        let powers = density.iter().zip(&widths).map(|(density, width)| density.powf(POWER) * width);
        let places: Vec<f64> = std::iter::once(0.0)
            .chain(powers.map(|power| {
                sum += power;
                sum
            }))
            .collect();
        let side = count / 2;
        // The tap in the middle has half of its interval on this side.
        #[allow(clippy::cast_precision_loss, reason = "taps are few")]
        let edge = |k: usize| match k {
            0 => 0.0,
            k if k > side => radius_mm,
            k => at(&places, grid.edges_mm(), sum * (k as f64 - 0.5) / (side as f64 + 0.5)),
        };
        let edges: Vec<f64> = (0..=side + 1).map(edge).collect();
        let mut offsets = vec![0.0];
        for ends in edges.windows(2).skip(1) {
            let (mut light, mut moment) = (0.0, 0.0);
            for (cell, density) in grid.edges_mm().windows(2).zip(&density) {
                let [from, to] = [cell[0].max(ends[0]), cell[1].min(ends[1])];
                if to > from {
                    light += density * (to - from);
                    moment += density * (to - from) * 0.5 * (from + to);
                }
            }
            offsets.push(if light > 0.0 { moment / light } else { 0.5 * (ends[0] + ends[1]) });
        }
        Self { edges, offsets }
    }

    /// Weights of a term: ∫ a over the intervals of the taps, which for the first has both sides of 0.
    pub(super) fn weights(&self, separable: &Separable, term: usize) -> Vec<f64> {
        let sums = separable.running(term);
        let to = |x: f64| separable.to(term, &sums, x);
        let weight = |(k, ends): (usize, &[f64])| (to(ends[1]) - to(ends[0])) * if k == 0 { 2.0 } else { 1.0 };
        self.edges.windows(2).enumerate().map(weight).collect()
    }
}

/// Where along `xs` the ascending `places` reach `place`.
fn at(places: &[f64], xs: &[f64], place: f64) -> f64 {
    let right = places.partition_point(|known| *known < place).clamp(1, places.len() - 1);
    let (a, b) = (places[right - 1], places[right]);
    let w = if b > a { (place - a) / (b - a) } else { 0.0 };
    xs[right - 1] + w * (xs[right] - xs[right - 1])
}
