//! P1: slices of luma along β, in bytes.

use super::database::slice_mean;
use crate::math::k_means::KMeans;
use crate::math::k_means::shape_gain::Match;
use crate::math::parallel;
use crate::math::side_by_side::{SideBySide, WIDTH};

/// Slices of `nodes` values, each with weights of its own for all of them.
pub(super) struct Slices<'a> {
    pub(super) nodes: usize,
    /// `[slice][node]`.
    pub(super) values: &'a [f32],
    /// Weight of every slice.
    pub(super) weights: Vec<f32>,
    /// Rows of weights of nodes; slice k has row k mod their number.
    pub(super) node_weights: &'a [f32],
    pub(super) is_signed: bool,
}

impl Slices<'_> {
    pub(super) fn len(&self) -> usize {
        self.values.len() / self.nodes
    }

    fn slice(&self, number: usize) -> (&[f32], &[f32]) {
        let rows = self.node_weights.len() / self.nodes;
        let (start, row) = (number * self.nodes, number % rows * self.nodes);
        (&self.values[start..start + self.nodes], &self.node_weights[row..row + self.nodes])
    }

    /// The row, and its gain, that leaves the least of each slice: Σ W x² − (Σ W x c)² / Σ W c².
    pub(super) fn search(&self, rows: &[f32]) -> Vec<Match> {
        let rows = SideBySide::new(rows, self.nodes);
        let find = |number: usize| {
            let (values, weights) = self.slice(number);
            let mut best = (0, 0.0, f32::NEG_INFINITY);
            for (first, block) in rows.blocks() {
                let (mut xc, mut cc) = ([0.0; WIDTH], [0.0; WIDTH]);
                for ((x, w), c) in values.iter().zip(weights).zip(block) {
                    for lane in 0..WIDTH {
                        let wc = w * c[lane];
                        xc[lane] += wc * x;
                        cc[lane] += wc * c[lane];
                    }
                }
                for lane in 0..WIDTH {
                    let (xc, cc) = (xc[lane], cc[lane]);
                    let is_positive = cc > 0.0 && (xc > 0.0 || self.is_signed);
                    if is_positive && xc * xc / cc > best.2 {
                        best = (first + lane, xc / cc, xc * xc / cc);
                    }
                }
            }
            Match { index: u32::try_from(best.0).expect("fewer than 2³² rows"), gain: best.1 }
        };
        parallel::map(self.len(), find)
    }

    /// Rows along Σ w g W x / Σ w g² W, their largest magnitude 1; those that none chose become slices that are large.
    pub(super) fn centroids(&self, matches: &[Match], count: usize) -> Vec<f32> {
        let mut sums = vec![[0.0_f64; 2]; count * self.nodes];
        for (number, found) in matches.iter().enumerate() {
            let (values, weights) = self.slice(number);
            let row = &mut sums[found.index as usize * self.nodes..][..self.nodes];
            let weight = f64::from(self.weights[number]);
            for ((sum, x), w) in row.iter_mut().zip(values).zip(weights) {
                let (g, w) = (f64::from(found.gain), weight * f64::from(*w));
                *sum = [sum[0] + w * g * f64::from(*x), sum[1] + w * g * g];
            }
        }
        #[allow(clippy::cast_possible_truncation, reason = "means of f32 values")]
        let mut rows: Vec<f32> =
            sums.iter().map(|[above, below]| if *below > 0.0 { (above / below) as f32 } else { 0.0 }).collect();
        let mut largest = self.by_size();
        for row in rows.chunks_exact_mut(self.nodes) {
            if !self.normalise(row)
                && let Some(number) = largest.next()
            {
                row.copy_from_slice(self.slice(number).0);
                self.normalise(row);
            }
        }
        rows
    }

    /// Cuts off what the format cannot hold and makes the largest magnitude 1; says whether anything is left.
    fn normalise(&self, row: &mut [f32]) -> bool {
        if !self.is_signed {
            row.iter_mut().for_each(|value| *value = value.max(0.0));
        }
        let largest = row.iter().fold(0.0_f32, |largest, value| largest.max(value.abs()));
        row.iter_mut().for_each(|value| *value /= largest.max(f32::MIN_POSITIVE));
        largest > 0.0
    }

    /// Slices by what they count times their squares, spread over all.
    fn by_size(&self) -> impl Iterator<Item = usize> {
        let size = |number: usize| {
            let (values, weights) = self.slice(number);
            self.weights[number] * values.iter().zip(weights).map(|(x, w)| w * x * x).sum::<f32>()
        };
        let mut order: Vec<(f32, usize)> = (0..self.len()).map(|number| (size(number), number)).collect();
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        order.into_iter().map(|(_, number)| number)
    }

    /// `count` rows by `rounds` of Lloyd's iteration.
    pub(super) fn cluster(&self, count: usize, rounds: usize) -> Vec<f32> {
        let count = count.min(self.len()).max(1);
        // Every so many of all, by size: small ones are there as well.
        let order: Vec<usize> = self.by_size().collect();
        let mut rows = Vec::with_capacity(count * self.nodes);
        for k in 0..count {
            let mut row = self.slice(order[k * order.len() / count]).0.to_vec();
            self.normalise(&mut row);
            rows.extend(row);
        }
        self.lloyd(rows, rounds, |_| true)
    }
}

impl KMeans for Slices<'_> {
    /// Rows `[row][node]`.
    type Codebook = Vec<f32>;
    type Assignment = Vec<Match>;

    fn assign(&self, rows: &Vec<f32>) -> Vec<Match> {
        self.search(rows)
    }

    fn update(&self, matches: &Vec<Match>, rows: &mut Vec<f32>) {
        *rows = self.centroids(matches, rows.len() / self.nodes);
    }
}

/// Rows as the file has them: bytes, and the code of their mean.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "values from −1 to 1")]
pub(crate) fn to_bytes(rows: &[f32], nodes: usize, is_signed: bool) -> Vec<u8> {
    let byte = |value: &f32| {
        if is_signed { ((value * 127.0).round() as i8).cast_unsigned() } else { (value * 255.0).round() as u8 }
    };
    let with_mean = |row: &[f32]| {
        let mut bytes: Vec<u8> = row.iter().map(byte).collect();
        bytes.push(if is_signed { 1 } else { slice_mean(&bytes) });
        bytes
    };
    rows.chunks_exact(nodes).flat_map(with_mean).collect()
}

/// Rows as the decoder has them, without the means.
pub(super) fn from_bytes(bytes: &[u8], nodes: usize, is_signed: bool) -> Vec<f32> {
    let value = |byte: &u8| if is_signed { f32::from(byte.cast_signed()) / 127.0 } else { f32::from(*byte) / 255.0 };
    bytes.chunks_exact(nodes + 1).flat_map(|row| row[..nodes].iter().map(value)).collect()
}
