//! The least-squares problem that all models share (Yatagawa et al. 2020, eq. 5), reduced to its normal equations.
//!
//! With y_e = 2 ln Rd of every measured entry e from pixel i to pixel j, and a(r) the hat weights of eq. 3, the cost is
//!
//! ½ Σ_e φ(r) (a·p_i + a·p_j − y_e)²,
//!
//! and its gradient with respect to the profile p_i is A_i p_i + Σ_j φ n_ij a aᵀ p_j − b_i, where n_ij counts the
//! measured directions between i and j (0 to 2), A_i = Σ_j φ n_ij a aᵀ and b_i = Σ_e φ y_e a. One pass over the
//! capture gives A and b; it is not needed again. Entries that were not measured are in neither sum: they weigh
//! nothing.
//!
//! All profiles are taken relative to one mean profile p̄, which every convex combination leaves alone: the numbers
//! that matter are small differences of large ones, and f32 has to hold them.

use std::collections::HashMap;

use rayon::prelude::*;
use subsurf_decoder::bssrdf::Addressing;

use crate::math::banded::Banded;
use crate::bssrdf::field::Field;
use crate::math::lanes::{self, Lanes, ZERO};
use crate::bssrdf::profiles::{RIDGE, SMOOTHNESS};
use crate::bssrdf::window::{Geometry, Ring, rings};
use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::progress::Progress;

/// Rows whose sums are made apart from those of others. Fixed, so that results do not depend on the number of threads.
pub(crate) const BLOCK_ROWS: usize = 8;
/// Blocks that are in memory together.
pub(crate) const BLOCKS_AT_ONCE: usize = 8;

/// A_i, and the part of it that comes from pairs of a pixel with itself.
#[derive(Clone, Debug)]
pub(crate) struct Matrix {
    /// Σ_j φ n a aᵀ.
    pub(crate) all: Banded,
    /// The same sum over the offsets that lead back to the pixel: r = 0, and more where a small patch repeats.
    pub(crate) own: Banded,
}

impl Matrix {
    /// The curvature of the cost in the pixel's own profile: a pair with itself moves at both ends.
    pub(crate) fn curvature(&self) -> Banded {
        let mut sum = self.all.clone();
        sum.add_scaled(1.0, &self.own);
        sum
    }
}

/// The normal equations of a capture.
pub(crate) struct Normal {
    pub(crate) geometry: Geometry,
    pub(crate) rings: Vec<Ring>,
    /// Distinct matrices, and which one a pixel has.
    pub(crate) matrices: Vec<Matrix>,
    pub(crate) matrix_of: Vec<u32>,
    /// Measured directions n of every pixel and offset in ring order, two bits per channel; `None` if all are 2.
    counts: Option<Vec<u8>>,
    /// b relative to the mean profile, `[pixel][node]`.
    b: Vec<Lanes>,
    /// p̄, natural log of mm⁻².
    pub(crate) mean: Vec<Lanes>,
    /// Σ_e φ y_e² relative to the mean profile.
    pub(crate) y2: f64,
    /// Mean of the light that a pixel sends out and that it gets from others, Σ_e Rd_e over all measured entries that
    /// begin or end at it, halved; in mm⁻².
    pub(crate) exchange: Vec<[f64; 3]>,
    /// Entries inside the material, and those of them that were measured; three channels make three entries.
    pub(crate) entries: [u64; 2],
}

/// Sums of one block of rows.
struct Block {
    /// First row of `b`, which reaches R rows beyond the block.
    first: usize,
    b: Vec<[f64; 3]>,
    /// Likewise.
    exchange: Vec<[f64; 3]>,
    y2: f64,
    /// Channels that were measured, three bits per pixel of the block and place in the window; `None` if all inside the
    /// material were.
    measured: Option<Vec<u8>>,
    entries: [u64; 2],
}

impl Normal {
    /// Reads a capture once.
    pub(crate) fn of(capture: &Capture, geometry: Geometry, progress: &dyn Progress) -> Result<Self> {
        let rings = rings(&geometry);
        let mut b = vec![[0.0; 3]; geometry.pixels() * geometry.nodes];
        let mut exchange = vec![[0.0; 3]; geometry.pixels()];
        let mut y2 = 0.0;
        let mut entries = [0; 2];
        let mut measured: Vec<Option<Vec<u8>>> = Vec::new();

        progress.begin("reading the capture", geometry.pixels() as u64);
        let firsts: Vec<usize> = (0..geometry.size[1]).step_by(BLOCK_ROWS).collect();
        for firsts in firsts.chunks(BLOCKS_AT_ONCE) {
            let blocks: Vec<Block> =
                firsts.par_iter().map(|&first| Block::read(capture, &geometry, &rings, first, progress)).collect();
            for block in blocks {
                block.add_to(&geometry, &mut b, &mut exchange);
                y2 += block.y2;
                entries[0] += block.entries[0];
                entries[1] += block.entries[1];
                measured.push(block.measured);
            }
        }
        if entries[1] == 0 {
            return Err(Error::input(
                capture.path(),
                "nothing measured: no entry inside the material is finite and positive",
                "at least one such entry",
            ));
        }
        let counts = counts(&geometry, &rings, &measured);
        drop(measured);
        let (matrices, matrix_of) = matrices(&geometry, &rings, counts.as_deref());
        let mut normal = Self {
            geometry,
            rings,
            matrices,
            matrix_of,
            counts,
            b: Vec::new(),
            mean: Vec::new(),
            exchange,
            y2,
            entries,
        };
        normal.centre(&b);
        Ok(normal)
    }

    /// Finds p̄ and makes b and y relative to it.
    fn centre(&mut self, b: &[[f64; 3]]) {
        let nodes = self.geometry.nodes;
        // One profile for all: 2 Σ A_i p̄ = Σ b_i.
        let mut system = self.mean_matrix();
        let pixels = self.geometry.pixels();
        let mut b_sum = vec![[0.0_f64; 3]; nodes];
        for pixel in b.chunks(nodes) {
            for (sum, b) in b_sum.iter_mut().zip(pixel) {
                for c in 0..3 {
                    sum[c] += b[c];
                }
            }
        }
        system.add_smoothness(SMOOTHNESS);
        system.add_ridge(RIDGE);
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_precision_loss,
            reason = "p̄ may be any profile near the mean"
        )]
        let mut mean: Vec<Lanes> = b_sum
            .iter()
            .map(|b| {
                let [r, g, b] = b.map(|b| (0.5 * b / pixels as f64) as f32);
                [r, g, b, 0.0]
            })
            .collect();
        system.factor().solve(&mut mean);

        // b_i − 2 A_i p̄.
        let mut centred = vec![ZERO; b.len()];
        centred.par_chunks_mut(nodes).enumerate().for_each(|(pixel, out)| {
            let [d0, d1, _] = &self.matrix(pixel).all.diagonals;
            let b = &b[pixel * nodes..][..nodes];
            for h in 0..nodes {
                for c in 0..3 {
                    let a = |diagonal: &[Lanes], h: usize| f64::from(diagonal[h][c]);
                    let p = |h: usize| f64::from(mean[h][c]);
                    let mut product = a(d0, h) * p(h);
                    if h > 0 {
                        product += a(d1, h - 1) * p(h - 1);
                    }
                    if h + 1 < nodes {
                        product += a(d1, h) * p(h + 1);
                    }
                    #[allow(clippy::cast_possible_truncation, reason = "small once the mean is gone")]
                    let value = (b[h][c] - 2.0 * product) as f32;
                    out[h][c] = value;
                }
            }
        });
        // Σ φ (y − 2 a·p̄)² = Σ φ y² − 2 p̄·Σ b_i + 2 p̄·(Σ A_i) p̄ .. with b_i' = b_i − 2 A_i p̄: Σ φ y² − p̄·Σ (b_i + b_i').
        for (pixel, b) in b.chunks(nodes).zip(centred.chunks(nodes)).map(|(b, c)| (c, b)) {
            for h in 0..nodes {
                for c in 0..3 {
                    self.y2 -= f64::from(mean[h][c]) * (b[h][c] + f64::from(pixel[h][c]));
                }
            }
        }
        self.b = centred;
        self.mean = mean;
    }

    pub(crate) fn matrix(&self, pixel: usize) -> &Matrix {
        &self.matrices[self.matrix_of[pixel] as usize]
    }

    /// How many pixels have each of the matrices.
    pub(crate) fn matrix_users(&self) -> Vec<u32> {
        let mut users = vec![0; self.matrices.len()];
        for &matrix in &self.matrix_of {
            users[matrix as usize] += 1;
        }
        users
    }

    /// The mean of A_i over all pixels.
    pub(crate) fn mean_matrix(&self) -> Banded {
        let mut mean = Banded::new(self.geometry.nodes);
        for (matrix, users) in self.matrices.iter().zip(self.matrix_users()) {
            #[allow(clippy::cast_precision_loss, reason = "a weight")]
            mean.add_scaled(users as f32 / self.geometry.pixels() as f32, &matrix.all);
        }
        mean
    }

    /// b_i.
    pub(crate) fn b(&self, pixel: usize) -> &[Lanes] {
        &self.b[pixel * self.geometry.nodes..][..self.geometry.nodes]
    }

    /// Σ_j φ n_ij a aᵀ p_j of one pixel, itself included.
    pub(crate) fn cross(&self, field: &Field, deltas: &[isize], pixel: usize, out: &mut [Lanes]) {
        out.fill(ZERO);
        let window = deltas.len();
        let counts = self.counts.as_ref().map(|counts| &counts[pixel * window..][..window]);
        let mut next = 0;
        for ring in &self.rings {
            let range = next..next + ring.offsets.len();
            next = range.end;
            let start = field.node(pixel, ring.h);
            let (mut below, mut above) = (ZERO, ZERO);
            if let Some(counts) = counts {
                for (delta, count) in deltas[range.clone()].iter().zip(&counts[range]) {
                    let [p, q] = field.pair(start, *delta);
                    let n = &COUNTS[usize::from(*count)];
                    lanes::add_product(&mut below, n, p);
                    lanes::add_product(&mut above, n, q);
                }
            } else {
                for delta in &deltas[range] {
                    let [p, q] = field.pair(start, *delta);
                    lanes::add(&mut below, p);
                    lanes::add(&mut above, q);
                }
                for c in 0..4 {
                    below[c] *= 2.0;
                    above[c] *= 2.0;
                }
            }
            let (w, phi) = (ring.w, ring.phi);
            for c in 0..4 {
                let p = phi * ((1.0 - w) * below[c] + w * above[c]);
                out[ring.h][c] += (1.0 - w) * p;
                out[ring.h + 1][c] += w * p;
            }
        }
    }

    /// d = b_i − Σ_{j≠i} φ n a aᵀ p_j of one pixel: with all others fixed, its profile p costs pᵀ A p − 2 pᵀ d, A being the
    /// curvature of [`Matrix::curvature`].
    pub(crate) fn pull(&self, field: &Field, deltas: &[isize], pixel: usize) -> Vec<Lanes> {
        let mut d = vec![ZERO; self.geometry.nodes];
        self.cross(field, deltas, pixel, &mut d);
        // The sum has the pixel's own old profile in it; take that out again.
        let mut own = vec![ZERO; self.geometry.nodes];
        self.matrix(pixel).own.multiply_add(field.at(pixel), &mut own);
        for ((d, own), b) in d.iter_mut().zip(&own).zip(self.b(pixel)) {
            for c in 0..4 {
                d[c] = b[c] - (d[c] - own[c]);
            }
        }
        d
    }

    /// Σ_j n_ij f_j of every ring, f a table with one node per ring.
    pub(crate) fn ring_sums(&self, table: &Field, deltas: &[isize], pixel: usize, out: &mut [Lanes]) {
        out.fill(ZERO);
        let window = deltas.len();
        let counts = self.counts.as_ref().map(|counts| &counts[pixel * window..][..window]);
        let mut next = 0;
        for (k, ring) in self.rings.iter().enumerate() {
            let range = next..next + ring.offsets.len();
            next = range.end;
            let start = table.node(pixel, k);
            let sum = &mut out[k];
            if let Some(counts) = counts {
                for (delta, count) in deltas[range.clone()].iter().zip(&counts[range]) {
                    lanes::add_product(sum, &COUNTS[usize::from(*count)], table.value(start, *delta));
                }
            } else {
                for delta in &deltas[range] {
                    lanes::add(sum, table.value(start, *delta));
                }
                for c in 0..4 {
                    sum[c] *= 2.0;
                }
            }
        }
    }

    /// Offsets in ring order as distances in a field's memory.
    pub(crate) fn deltas(&self, field: &Field) -> Vec<isize> {
        self.rings.iter().flat_map(|ring| ring.offsets.iter().map(|offset| field.delta(offset.step))).collect()
    }

    /// ½ Σ_e φ (a·p_i + a·p_j − y_e)².
    pub(crate) fn cost(&self, field: &Field) -> f64 {
        let deltas = self.deltas(field);
        let nodes = self.geometry.nodes;
        let rows: Vec<f64> = (0..self.geometry.pixels())
            .into_par_iter()
            .map(|pixel| {
                let mut image = vec![ZERO; nodes];
                self.cross(field, &deltas, pixel, &mut image);
                self.matrix(pixel).all.multiply_add(field.at(pixel), &mut image);
                let quadratic = lanes::dot(field.at(pixel), &image);
                let linear = lanes::dot(field.at(pixel), self.b(pixel));
                (0..3).map(|c| quadratic[c] - 2.0 * linear[c]).sum()
            })
            .collect();
        0.5 * (rows.iter().sum::<f64>() + self.y2)
    }
}

/// Lanes of a packed count.
static COUNTS: [Lanes; 64] = {
    let mut table = [ZERO; 64];
    let mut packed = 0;
    while packed < 64 {
        let mut c = 0;
        while c < 3 {
            table[packed][c] = ((packed >> (2 * c)) & 3) as f32;
            c += 1;
        }
        packed += 1;
    }
    table
};

/// All channels.
const ALL: u8 = 0b111;

impl Block {
    fn read(capture: &Capture, geometry: &Geometry, rings: &[Ring], first: usize, progress: &dyn Progress) -> Self {
        let [width, height] = geometry.size;
        let rows = BLOCK_ROWS.min(height - first);
        let window_len = capture.window_len();
        let places = window_len / 3;
        let mut window = vec![0.0; window_len];
        let reach = (rows + 2 * geometry.radius) * (width + 2 * geometry.radius);
        // Sums of all rows that a window of the block can reach: it goes on beyond the border and is folded back later.
        let mut block = Self {
            first,
            b: vec![[0.0; 3]; reach * geometry.nodes],
            exchange: vec![[0.0; 3]; reach],
            y2: 0.0,
            measured: None,
            entries: [0; 2],
        };
        for row in 0..rows {
            for x in 0..width {
                let pixel = (first + row) * width + x;
                capture.read_window(pixel, &mut window);
                let here = block.start(geometry, row, [x, 0], [0, 0]);
                for ring in rings {
                    let phi = f64::from(ring.phi);
                    let w = f64::from(ring.w);
                    for offset in &ring.offsets {
                        if geometry.neighbour(pixel, offset.step).is_none() {
                            continue;
                        }
                        let there = block.start(geometry, row, [x, 0], offset.step);
                        let mut channels = 0_u8;
                        for c in 0..3 {
                            let rd = window[offset.place * 3 + c];
                            if rd <= 0.0 {
                                continue;
                            }
                            channels |= 1 << c;
                            let y = 2.0 * f64::from(rd.ln());
                            block.y2 += phi * y * y;
                            for at in [here, there] {
                                block.exchange[at / geometry.nodes][c] += 0.5 * f64::from(rd);
                                block.b[at + ring.h][c] += phi * (1.0 - w) * y;
                                block.b[at + ring.h + 1][c] += phi * w * y;
                            }
                        }
                        block.entries[0] += 3;
                        block.entries[1] += u64::from(channels.count_ones());
                        if channels != ALL {
                            let all = || vec![ALL; rows * width * places];
                            let measured = block.measured.get_or_insert_with(all);
                            measured[(row * width + x) * places + offset.place] = channels;
                        }
                    }
                }
            }
            progress.advance(width as u64);
        }
        block
    }

    /// First value in `b` of the pixel `step` away from column x of a row of the block.
    fn start(&self, geometry: &Geometry, row: usize, [x, _]: [usize; 2], step: [i32; 2]) -> usize {
        let [column, row] = [(x, step[0]), (row, step[1])].map(|(k, step)| {
            (k + geometry.radius).wrapping_add_signed(isize::try_from(step).expect("windows are small"))
        });
        (row * (geometry.size[0] + 2 * geometry.radius) + column) * geometry.nodes
    }

    /// Adds the block's sums to those of all pixels; what lies beyond the border goes where the addressing says.
    fn add_to(&self, geometry: &Geometry, b: &mut [[f64; 3]], exchange: &mut [[f64; 3]]) {
        let radius = i32::try_from(geometry.radius).expect("a window radius is below 1,024");
        let stride = geometry.size[0] + 2 * geometry.radius;
        let first = i32::try_from(self.first).expect("a side is below 65,536");
        for (k, profile) in self.b.chunks(geometry.nodes).enumerate() {
            let [x, y] = [k % stride, k / stride].map(|k| i32::try_from(k).expect("a side is below 65,536") - radius);
            let Some(pixel) = geometry.neighbour(0, [x, first + y]) else {
                continue;
            };
            for (sum, b) in b[pixel * geometry.nodes..].iter_mut().zip(profile) {
                for c in 0..3 {
                    sum[c] += b[c];
                }
            }
            for c in 0..3 {
                exchange[pixel][c] += self.exchange[k][c];
            }
        }
    }
}

/// n of every pixel and offset in ring order, from the channels measured in each direction; `None` if nothing is missing.
fn counts(geometry: &Geometry, rings: &[Ring], measured: &[Option<Vec<u8>>]) -> Option<Vec<u8>> {
    if measured.iter().all(Option::is_none) {
        return None;
    }
    let places = rings.iter().map(|ring| ring.offsets.len()).sum::<usize>();
    let width = geometry.size[0];
    let channels = |pixel: usize, place: usize| {
        let (block, row) = (pixel / width / BLOCK_ROWS, pixel / width % BLOCK_ROWS);
        let at = (row * width + pixel % width) * places + place;
        measured[block].as_ref().map_or(ALL, |measured| measured[at])
    };
    // Three bits spread to two bits each.
    let spread = |channels: u8| (channels & 1) | (channels & 2) << 1 | (channels & 4) << 2;
    let mut counts = vec![0; geometry.pixels() * places];
    counts.par_chunks_mut(places).enumerate().for_each(|(pixel, counts)| {
        let offsets = rings.iter().flat_map(|ring| &ring.offsets);
        for (count, offset) in counts.iter_mut().zip(offsets) {
            if let Some(other) = geometry.neighbour(pixel, offset.step) {
                let back = geometry.place(geometry.way_back(pixel, offset.step));
                *count = spread(channels(pixel, offset.place)) + spread(channels(other, back));
            }
        }
    });
    Some(counts)
}

/// A_i of every pixel. Without missing entries it depends on the distance from the border alone.
fn matrices(geometry: &Geometry, rings: &[Ring], counts: Option<&[u8]>) -> (Vec<Matrix>, Vec<u32>) {
    let window = rings.iter().map(|ring| ring.offsets.len()).sum::<usize>();
    let matrix = |pixel: usize| {
        let mut matrix = Matrix { all: Banded::new(geometry.nodes), own: Banded::new(geometry.nodes) };
        let mut at = pixel * window;
        for ring in rings {
            let (mut all, mut own) = (ZERO, ZERO);
            for offset in &ring.offsets {
                let other = geometry.neighbour(pixel, offset.step);
                if other.is_some() {
                    let n = counts.map_or([2.0, 2.0, 2.0, 0.0], |counts| COUNTS[usize::from(counts[at])]);
                    lanes::add_scaled(&mut all, ring.phi, &n);
                    if other == Some(pixel) {
                        lanes::add_scaled(&mut own, ring.phi, &n);
                    }
                }
                at += 1;
            }
            matrix.all.add_hat(ring.h, ring.w, &all);
            matrix.own.add_hat(ring.h, ring.w, &own);
        }
        matrix
    };
    let numbers = 0..u32::try_from(geometry.pixels()).expect("captures have fewer than 2³² pixels");
    if counts.is_some() {
        let matrices = (0..geometry.pixels()).into_par_iter().map(matrix).collect();
        return (matrices, numbers.collect());
    }
    let mut known: HashMap<[usize; 4], u32> = HashMap::new();
    let mut matrices = Vec::new();
    let matrix_of = (0..geometry.pixels())
        .map(|pixel| {
            *known.entry(border_class(geometry, pixel)).or_insert_with(|| {
                matrices.push(matrix(pixel));
                u32::try_from(matrices.len() - 1).expect("no more matrices than pixels")
            })
        })
        .collect();
    (matrices, matrix_of)
}

/// Pixels of one class have the same A: distances from the borders up to R, without regard to reflections.
fn border_class(geometry: &Geometry, pixel: usize) -> [usize; 4] {
    if geometry.addressing == Addressing::Repeat {
        return [0; 4];
    }
    let position = geometry.position(pixel);
    let mut axes = [0, 1].map(|axis| {
        let before = position[axis].min(geometry.radius);
        let behind = (geometry.size[axis] - 1 - position[axis]).min(geometry.radius);
        [before.min(behind), before.max(behind)]
    });
    axes.sort_unstable();
    [axes[0][0], axes[0][1], axes[1][0], axes[1][1]]
}
