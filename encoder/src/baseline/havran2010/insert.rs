//! Pruning: what is not near enough to anything that is there already becomes an entry of its own, in parts.

use rayon::prelude::*;
use subsurf_decoder::btf::Grid;

use super::codebooks::{Codebooks, Scaled};
use super::functions::Function;
use super::measure::{Measure, Part, Piece, Tally};
use super::rows::Row;
use super::similarity::Allowed;

/// Entries that are compared by one thread in a row.
const CHUNK: usize = 128;
/// Luma below this is black: it has no shape.
const BLACK: f32 = 1e-6;

/// What brings one mean to the other.
pub(super) fn gain(mean: f32, of_entry: f32) -> f32 {
    if of_entry > BLACK { mean / of_entry } else { 0.0 }
}

/// The entry that is least far away, the first of equals, if any is nearer than `bound`. `score` says how far entries are
/// that are nearer than a bound.
fn nearest(count: usize, bound: f32, score: impl Fn(usize, f32, &mut Tally) -> Option<f32> + Sync) -> Option<usize> {
    let chunk = |first: usize| {
        let (mut best, mut tally) = ((bound, None), Tally::default());
        for entry in first..count.min(first + CHUNK) {
            if let Some(score) = score(entry, best.0, &mut tally) {
                best = (score, Some(entry));
            }
        }
        best.1.map(|entry| (best.0, entry))
    };
    let starts = (0..count.div_ceil(CHUNK)).into_par_iter().map(|k| k * CHUNK);
    let best = starts.filter_map(chunk).min_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
    best.map(|(_, entry)| entry)
}

fn entry(number: usize) -> u32 {
    u32::try_from(number).expect("fewer than 2³² entries")
}

/// Codebooks that grow by pruning.
pub(super) struct Pruning<'a> {
    pub(super) codebooks: Codebooks,
    measure: &'a Measure,
    allowed: Allowed,
}

impl<'a> Pruning<'a> {
    pub(super) fn new(grid: Grid, measure: &'a Measure, allowed: Allowed) -> Self {
        Self { codebooks: Codebooks::new(grid), measure, allowed }
    }

    /// Changes what vectors may differ.
    pub(super) fn allow(&mut self, allowed: Allowed) {
        self.allowed = allowed;
    }

    /// Makes sure that there is an entry of P4 for it.
    pub(super) fn insert(&mut self, function: &Function) {
        let (n_phi, n_theta) = (self.codebooks.n_phi(), self.codebooks.n_theta());
        let part = Part::new(function, 0, n_phi * n_theta);
        let mean = part.mean();
        let (pieces, means) = &self.codebooks.of_p4;
        let score = |k: usize, bound: f32, tally: &mut Tally| {
            let pieces = &pieces[k * n_phi * n_theta..][..n_phi * n_theta];
            self.measure.whole(&part, pieces, &self.codebooks.decoded, gain(mean, means[k]), bound, tally)
        };
        if nearest(means.len(), self.allowed.p4, score).is_none() {
            let items: Vec<Scaled> = (0..n_phi).map(|phi| self.insert3(function, phi, mean)).collect();
            self.codebooks.push_p4(&items);
        }
    }

    /// The slice at a node of φ_v as an entry of P3, and its gain where the mean is `mean`.
    fn insert3(&mut self, function: &Function, phi: usize, mean: f32) -> Scaled {
        let n_theta = self.codebooks.n_theta();
        let part = Part::new(function, phi * n_theta, n_theta);
        let of_part = part.mean();
        let (pieces, means) = &self.codebooks.of_p3;
        let score = |k: usize, bound: f32, tally: &mut Tally| {
            let pieces = &pieces[k * n_theta..(k + 1) * n_theta];
            self.measure.whole(&part, pieces, &self.codebooks.decoded, gain(of_part, means[k]), bound, tally)
        };
        let number = nearest(means.len(), self.allowed.p3, score).map_or_else(
            || {
                let slices = phi * n_theta..(phi + 1) * n_theta;
                let items: Vec<Scaled> = slices.map(|slice| self.insert2(function, slice, of_part)).collect();
                self.codebooks.push_p3(&items)
            },
            entry,
        );
        (number, gain(of_part, self.codebooks.of_p3.1[number as usize]) / mean.max(BLACK))
    }

    /// A 2-D slice as an entry of M.
    fn insert2(&mut self, function: &Function, slice: usize, mean: f32) -> Scaled {
        let part = Part::new(function, slice, 1);
        let of_part = part.mean();
        let score = |k: usize, bound: f32, tally: &mut Tally| {
            let [p2, i2] = self.codebooks.merged[k];
            let scale = gain(of_part, self.codebooks.of_p2[p2 as usize]);
            let piece = Piece { p2, i2, gain: 1.0 };
            self.measure.whole(&part, &[piece], &self.codebooks.decoded, scale, bound, tally)
        };
        let number = nearest(self.codebooks.merged.len(), self.allowed.merged, score).map_or_else(
            || {
                let pair = [self.insert_luma(function, slice, of_part), self.insert_chroma(function, slice)];
                self.codebooks.merge(pair)
            },
            entry,
        );
        let [p2, _] = self.codebooks.merged[number as usize];
        (number, gain(of_part, self.codebooks.of_p2[p2 as usize]) / mean.max(BLACK))
    }

    /// Luma of a 2-D slice as an entry of P2.
    fn insert_luma(&mut self, function: &Function, slice: usize, mean: f32) -> u32 {
        let score = |k: usize, bound: f32, tally: &mut Tally| {
            let scale = gain(mean, self.codebooks.of_p2[k]);
            self.measure.luma((&function.luma, slice), (&self.codebooks.decoded.luma, k), scale, bound, tally)
        };
        if let Some(found) = nearest(self.codebooks.of_p2.len(), self.allowed.p2, score) {
            return entry(found);
        }
        let n_alpha = self.codebooks.n_alpha();
        let insert = |alpha: usize| {
            let row = function.luma.row(slice, alpha);
            let row = Row::new(&row);
            let number = self.insert_row(row);
            (number, gain(row.mean, self.codebooks.p1.row(number as usize).mean) / mean.max(BLACK))
        };
        let items: Vec<Scaled> = (0..n_alpha).map(insert).collect();
        self.codebooks.push_p2(&items)
    }

    /// Luma of a 1-D slice as an entry of P1.
    fn insert_row(&mut self, row: Row<'_>) -> u32 {
        let score = |k: usize, bound: f32, _: &mut Tally| {
            let of_entry = self.codebooks.p1.row(k);
            let score = self.measure.row(row, of_entry, gain(row.mean, of_entry.mean));
            (score < bound).then_some(score)
        };
        nearest(self.codebooks.p1.len(), self.allowed.p1, score).map_or_else(
            || {
                let largest = row.values.iter().fold(0.0_f32, |largest, value| largest.max(*value));
                let scale = if largest > BLACK { 1.0 / largest } else { 0.0 };
                let normal: Vec<f32> = row.values.iter().map(|value| scale * value).collect();
                self.codebooks.push_p1(&normal)
            },
            entry,
        )
    }

    /// Chroma of a 2-D slice as an entry of I2.
    fn insert_chroma(&mut self, function: &Function, slice: usize) -> u32 {
        let (n_alpha, chroma) = (self.codebooks.n_alpha(), &function.chroma);
        let score = |k: usize, bound: f32, tally: &mut Tally| {
            self.measure.chroma((chroma, slice), (&self.codebooks.decoded.chroma, k), bound, tally)
        };
        if let Some(found) = nearest(self.codebooks.i2.len() / n_alpha, self.allowed.i2, score) {
            return entry(found);
        }
        let insert = |alpha: usize| {
            let [a, b] = [0, 1].map(|c: usize| chroma[c].row(slice, alpha));
            self.insert_hues([Row::new(&a), Row::new(&b)])
        };
        let slices: Vec<u32> = (0..n_alpha).map(insert).collect();
        self.codebooks.push_i2(&slices)
    }

    /// Chroma of a 1-D slice as an entry of I1.
    fn insert_hues(&mut self, rows: [Row<'_>; 2]) -> u32 {
        let score = |k: usize, bound: f32, tally: &mut Tally| {
            let of_entry = [0, 1].map(|c: usize| self.codebooks.of_i1[c].row(k));
            self.measure.hues(rows, of_entry, bound, tally)
        };
        if let Some(found) = nearest(self.codebooks.of_i1[0].len(), self.allowed.i1, score) {
            return entry(found);
        }
        let n_beta = self.codebooks.n_beta();
        let insert = |node: usize| self.insert_colour(rows.map(|row| row.values[node]));
        let colours: Vec<u32> = (0..n_beta).map(insert).collect();
        self.codebooks.push_i1(&colours)
    }

    /// A colour as an entry of C.
    fn insert_colour(&mut self, colour: [f32; 2]) -> u32 {
        let score = |k: usize, bound: f32, tally: &mut Tally| {
            self.measure.colours(colour, self.codebooks.colours[k], bound, tally)
        };
        nearest(self.codebooks.colours.len(), self.allowed.colours, score)
            .map_or_else(|| self.codebooks.push_colour(colour), entry)
    }
}
