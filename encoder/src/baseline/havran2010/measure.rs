//! What similarity is computed from: slices along β, one at a time, until it is known whether it is enough.

use glam::Vec4;
use subsurf_decoder::btf::{ColourEncoding, Grid};

use super::functions::Function;
use super::rows::{Group, Row, Slices};
use super::similarity::Similarity;

/// (0.01)² and (0.03)²: Wang et al. 2004, for values up to 1.
const C1: f32 = 1e-4;
const C2: f32 = 9e-4;
/// Of a hundred windows, two may be worse than what is said of all.
const OUTLIERS: f32 = 0.02;

/// 1 − structural similarity of two windows by their means, variances and covariance.
#[inline]
fn dissimilarity([mean_x, mean_y]: [f32; 2], [var_x, var_y]: [f32; 2], covariance: f32) -> f32 {
    let above = (2.0 * mean_x * mean_y + C1) * (2.0 * covariance + C2);
    let below = (mean_x * mean_x + mean_y * mean_y + C1) * (var_x + var_y + C2);
    1.0 - above / below
}

/// Collects what rows differ, and knows when they differ too much.
#[derive(Debug, Default)]
pub(super) struct Tally {
    is_mean: bool,
    bound: f32,
    count: usize,
    /// Sum of differences, for means.
    sum: f32,
    /// Differences that may exceed the bound, for percentiles.
    outliers: usize,
    bad: usize,
    seen: Vec<Vec4>,
}

impl Tally {
    /// Of `count` differences that are to stay below `bound` in their mean, or in their 98th percentile.
    fn begin(&mut self, is_mean: bool, count: usize, bound: f32) {
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "few thousand windows")]
        let outliers = (OUTLIERS * count as f32) as usize;
        self.seen.clear();
        *self = Self { is_mean, bound, count, sum: 0.0, outliers, bad: 0, seen: std::mem::take(&mut self.seen) };
    }

    /// Says whether they can still stay below.
    fn add(&mut self, differences: [f32; 2]) -> bool {
        self.add_group(Vec4::from_array([differences[0], differences[1], 0.0, 0.0]))
    }

    /// [`Self::add`] of rows side by side. Those that are not there differ by 0, which changes neither sums nor percentiles.
    #[inline]
    fn add_group(&mut self, differences: Vec4) -> bool {
        if self.is_mean {
            self.sum += differences.element_sum();
            self.sum < self.bound * self.count as f32
        } else {
            self.seen.push(differences);
            self.bad += differences.cmpge(Vec4::splat(self.bound)).bitmask().count_ones() as usize;
            self.bad <= self.outliers
        }
    }

    fn finish(&mut self) -> f32 {
        if self.is_mean {
            self.sum / self.count as f32
        } else {
            let mut seen: Vec<f32> = self.seen.iter().flat_map(|lanes| lanes.to_array()).collect();
            *seen.select_nth_unstable_by(self.outliers, |a, b| b.total_cmp(a)).1
        }
    }
}

/// A 2-D slice as codebooks have it: an entry of P2 times a gain, and one of I2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Piece {
    pub(super) p2: u32,
    pub(super) i2: u32,
    pub(super) gain: f32,
}

/// What P2 and I2 decode to.
#[derive(Clone, Debug)]
pub(super) struct Decoded {
    pub(super) luma: Slices,
    pub(super) chroma: [Slices; 2],
}

/// 2-D slices of an apparent BRDF that follow each other, and the order in which they are best compared.
pub(super) struct Part<'a> {
    pub(super) function: &'a Function,
    pub(super) first: usize,
    order: Vec<usize>,
}

impl<'a> Part<'a> {
    /// `count` slices from slice `first` on.
    pub(super) fn new(function: &'a Function, first: usize, count: usize) -> Self {
        // What has most contrast differs first.
        let contrast = |slice: usize| function.luma.variance(first + slice..first + slice + 1);
        let contrasts: Vec<f32> = (0..count).map(contrast).collect();
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by(|a, b| contrasts[*b].total_cmp(&contrasts[*a]).then(a.cmp(b)));
        Self { function, first, order }
    }

    /// Mean luma of all slices.
    pub(super) fn mean(&self) -> f32 {
        self.function.luma.mean(self.first..self.first + self.order.len())
    }
}

/// One of the two measures, and what it needs to know.
#[derive(Clone, Debug)]
pub(super) struct Measure {
    is_mse: bool,
    /// What the nodes of a slice count: the poles, which all slices share, once in all of them. They add up to 1.
    shares: Vec<f32>,
    /// Red, green and blue from luma and chroma, as far as differences go.
    rgb: [[f32; 3]; 3],
}

impl Measure {
    pub(super) fn new(similarity: &Similarity, grid: &Grid, tone: ColourEncoding) -> Self {
        let n_beta = usize::from(grid.n_beta);
        let mut shares = vec![1.0; n_beta];
        if grid.sin_beta_max >= 1.0 {
            (shares[0], shares[n_beta - 1]) = (1.0 / f32::from(grid.n_alpha), 1.0 / f32::from(grid.n_alpha));
        }
        let sum: f32 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= sum);
        let rgb = match tone {
            ColourEncoding::Display { .. } => {
                // Around a grey that is bright enough for nothing to be cut off at black.
                let at = |channels: [f32; 3]| tone.decode([8.0 + channels[0], channels[1], channels[2]]);
                let (grey, columns) = (at([0.0; 3]), [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(at));
                [0, 1, 2].map(|k: usize| columns.map(|column| column[k] - grey[k]))
            }
            ColourEncoding::LogLuv { .. } => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
        };
        Self { is_mse: matches!(similarity, Similarity::Mse { .. }), shares, rgb }
    }

    /// What `gain` times a row differs from another.
    pub(super) fn row(&self, x: Row<'_>, y: Row<'_>, gain: f32) -> f32 {
        let both = x.values.iter().zip(y.values);
        if self.is_mse {
            both.zip(&self.shares).map(|((x, y), share)| share * (x - gain * y) * (x - gain * y)).sum()
        } else {
            let products: f32 = both.map(|(x, y)| x * y).sum();
            let covariance = products / self.shares.len() as f32 - x.mean * y.mean;
            dissimilarity([x.mean, gain * y.mean], [x.variance, gain * gain * y.variance], gain * covariance)
        }
    }

    /// [`Self::row`] of rows side by side.
    #[inline]
    fn group(&self, x: Group<'_>, y: Group<'_>, gain: f32) -> Vec4 {
        let both = x.values.iter().zip(y.values);
        if self.is_mse {
            both.zip(&self.shares).map(|((x, y), share)| *share * (*x - gain * *y) * (*x - gain * *y)).sum()
        } else {
            let products: Vec4 = both.map(|(x, y)| *x * *y).sum();
            let covariances = products * (1.0 / self.shares.len() as f32) - x.means * y.means;
            let (means, variances) = (gain * y.means, gain * gain * y.variances);
            let above = (2.0 * x.means * means + C1) * (2.0 * gain * covariances + C2);
            let below = (x.means * x.means + means * means + C1) * (x.variances + variances + C2);
            Vec4::ONE - above / below
        }
    }

    /// Squared differences of red, green and blue, of rows side by side.
    fn of_rgb(&self, x: [Group<'_>; 3], y: [Group<'_>; 3], gain: f32) -> [Vec4; 3] {
        let mut sums = [Vec4::ZERO; 3];
        for (node, share) in self.shares.iter().enumerate() {
            let of_luma = x[0].values[node] - gain * y[0].values[node];
            let [a, b] = [1, 2].map(|c: usize| x[c].values[node] - y[c].values[node]);
            for (sum, [of_y, of_a, of_b]) in sums.iter_mut().zip(self.rgb) {
                let difference = of_y * of_luma + of_a * a + of_b * b;
                *sum += *share * difference * difference;
            }
        }
        sums
    }

    /// How far colours are from each other, if less than `bound`.
    pub(super) fn colours(&self, x: [f32; 2], y: [f32; 2], bound: f32, tally: &mut Tally) -> Option<f32> {
        tally.begin(self.is_mse, 2, bound);
        let differ = |c: usize| {
            if self.is_mse { (x[c] - y[c]) * (x[c] - y[c]) } else { dissimilarity([x[c], y[c]], [0.0; 2], 0.0) }
        };
        tally.add([differ(0), differ(1)]).then(|| tally.finish())
    }

    /// How far chroma of 1-D slices is from others, if less than `bound`.
    pub(super) fn hues(&self, x: [Row<'_>; 2], y: [Row<'_>; 2], bound: f32, tally: &mut Tally) -> Option<f32> {
        tally.begin(self.is_mse, 2, bound);
        tally.add([0, 1].map(|c| self.row(x[c], y[c], 1.0))).then(|| tally.finish())
    }

    /// How far luma of a 2-D slice is from `gain` times another, if less than `bound`.
    pub(super) fn luma(
        &self,
        (x, slice): (&Slices, usize),
        (y, entry): (&Slices, usize),
        gain: f32,
        bound: f32,
        tally: &mut Tally,
    ) -> Option<f32> {
        let groups = x.groups();
        tally.begin(self.is_mse, x.n_alpha(), bound);
        let of = |k: usize| self.group(x.group(slice * groups + k), y.group(entry * groups + k), gain);
        (0..groups).all(|k| tally.add_group(of(k))).then(|| tally.finish())
    }

    /// How far chroma of a 2-D slice is from another, if less than `bound`.
    pub(super) fn chroma(
        &self,
        (x, slice): (&[Slices; 2], usize),
        (y, entry): (&[Slices; 2], usize),
        bound: f32,
        tally: &mut Tally,
    ) -> Option<f32> {
        let groups = x[0].groups();
        tally.begin(self.is_mse, 2 * x[0].n_alpha(), bound);
        let of = |c: usize, k: usize| self.group(x[c].group(slice * groups + k), y[c].group(entry * groups + k), 1.0);
        (0..groups).all(|k| tally.add_group(of(0, k)) && tally.add_group(of(1, k))).then(|| tally.finish())
    }

    /// How far slices with their colours are from `gain` times pieces, if less than `bound`.
    pub(super) fn whole(
        &self,
        part: &Part<'_>,
        pieces: &[Piece],
        decoded: &Decoded,
        gain: f32,
        bound: f32,
        tally: &mut Tally,
    ) -> Option<f32> {
        let Function { luma, chroma } = part.function;
        let groups = luma.groups();
        tally.begin(self.is_mse, 3 * luma.n_alpha() * pieces.len(), bound);
        let of = |slice: usize| {
            let piece = &pieces[slice];
            let first = [part.first + slice, piece.p2 as usize, piece.i2 as usize].map(|slice| slice * groups);
            (first, gain * piece.gain)
        };
        let hues = |[x, _, y]: [usize; 3], k: usize| {
            [0, 1].map(|c: usize| [chroma[c].group(x + k), decoded.chroma[c].group(y + k)])
        };
        let can_do = if self.is_mse {
            part.order.iter().all(|slice| {
                let (first, gain) = of(*slice);
                (0..groups).all(|k| {
                    let ([x, y, _], [[xa, ya], [xb, yb]]) = (first, hues(first, k));
                    let (x, y) = ([luma.group(x + k), xa, xb], [decoded.luma.group(y + k), ya, yb]);
                    self.of_rgb(x, y, gain).into_iter().all(|lanes| tally.add_group(lanes))
                })
            })
        } else {
            // Luma first: where it is not alike, chroma need not be looked at.
            part.order.iter().all(|slice| {
                let ([x, y, _], gain) = of(*slice);
                (0..groups).all(|k| tally.add_group(self.group(luma.group(x + k), decoded.luma.group(y + k), gain)))
            }) && part.order.iter().all(|slice| {
                let (first, _) = of(*slice);
                let mut add = |[x, y]: [Group<'_>; 2]| tally.add_group(self.group(x, y, 1.0));
                (0..groups).all(|k| hues(first, k).into_iter().all(&mut add))
            })
        };
        can_do.then(|| tally.finish())
    }
}
