//! Codebooks of luma: clustered top-down, 4-D to 1-D, then chosen anew bottom-up against what is decoded.

use nalgebra::DMatrix;
use subsurf_decoder::btf::Grid;
use subsurf_decoder::btf::nested::layout::Scales;

use super::database::{Chain, Item};
use super::scales::{Fineness, code, gain, scales};
use super::sizes::Sizes;
use super::slices::{Slices, from_bytes, to_bytes};
use crate::btf::resample::Measured;
use crate::math::k_means::shape_gain::{Match, Samples};
use crate::math::matrix::product;
use crate::math::parallel;
use crate::progress::Progress;

/// Fineness of scales of P6, P4, P3 and P2.
const FINENESS: [Fineness; 4] = [Fineness { bits: 8, step: 1 }, FINE, FINE, FINE];
/// Four octaves in steps of 1/32: coarser steps are seen as noise on smooth materials.
const FINE: Fineness = Fineness { bits: 7, step: 1 };
/// Rounds of Lloyd's iteration of 4-D and 3-D, 2-D and 1-D codebooks.
const ROUNDS: usize = 8;
/// Times that all codebooks are chosen anew against what is decoded.
const LOOPS: usize = 3;
/// Steps of progress of a stage.
pub(super) const STEPS: u64 = 1 + 4 * LOOPS as u64;
/// Least weight of a node, in mean ones: what nothing was measured of is not to be anything.
const LEAST_WEIGHT: f32 = 0.02;

/// Directions, as all stages need them.
pub(super) struct Space<'a> {
    pub(super) grid: Grid,
    pub(super) measured: &'a Measured,
    /// Weight w of every pair of directions.
    pub(super) weights: &'a [f32],
    /// Weighted components at pairs, orthonormal columns.
    pub(super) basis: &'a DMatrix<f32>,
    /// Components at nodes, without weights.
    pub(super) tables: &'a DMatrix<f32>,
}

/// Codebooks of a stage, and what they decode to.
pub(super) struct Built {
    pub(super) chain: Chain,
    /// Entries of P4 at the nodes of the grid, in columns.
    pub(super) decoded: DMatrix<f32>,
    /// Coefficients of the entries of P4, in columns.
    pub(super) projected: DMatrix<f32>,
}

/// Square roots of weights of nodes, by which values are multiplied before they are compared.
struct Roots {
    /// `[θ][α][β]`.
    three: Vec<f32>,
    /// `[α][β]`.
    two: Vec<f32>,
    /// How much each θ counts.
    of_theta: Vec<f32>,
}

impl Space<'_> {
    fn roots(&self) -> Roots {
        let squares: Vec<f32> = self.weights.iter().map(|weight| weight * weight).collect();
        let all = self.measured.spread(&squares);
        let mean_over = |values: &[f32], length: usize| -> Vec<f32> {
            let count = (values.len() / length) as f32;
            (0..length).map(|k| values[k..].iter().step_by(length).sum::<f32>() / count).collect()
        };
        let (light, theta) = (self.grid.light_nodes(), usize::from(self.grid.n_theta));
        let (three, two) = (mean_over(&all, theta * light), mean_over(&all, light));
        let mean = two.iter().sum::<f32>() / light as f32;
        let root = |weights: &[f32]| -> Vec<f32> {
            weights.iter().map(|weight| (weight / mean).max(LEAST_WEIGHT).sqrt()).collect()
        };
        let of_theta = three.chunks(light).map(|slice| slice.iter().sum::<f32>() / (light as f32 * mean)).collect();
        Roots { three: root(&three), two: root(&two), of_theta }
    }

    /// Coefficients of tables, and the lengths of what they are at all pairs.
    fn project(&self, decoded: &DMatrix<f32>) -> (DMatrix<f32>, Vec<f32>) {
        let read = |table: usize| {
            let mut values = self.measured.read(decoded.column(table).as_slice());
            values.iter_mut().zip(self.weights).for_each(|(value, weight)| *value *= weight);
            values
        };
        const BLOCK: usize = 256;
        let mut coefficients = DMatrix::zeros(self.basis.ncols(), decoded.ncols());
        let mut lengths = Vec::with_capacity(decoded.ncols());
        let transposed = self.basis.transpose();
        for first in (0..decoded.ncols()).step_by(BLOCK) {
            let count = BLOCK.min(decoded.ncols() - first);
            let values: Vec<Vec<f32>> = parallel::map(count, |k| read(first + k));
            lengths.extend(values.iter().map(|values| values.iter().map(|value| value * value).sum::<f32>().sqrt()));
            let values = DMatrix::from_vec(self.weights.len(), count, values.concat());
            coefficients.columns_mut(first, count).copy_from(&product(&transposed, &values));
        }
        (coefficients, lengths)
    }

    /// Builds a stage for texels by their coefficients.
    pub(super) fn build(
        &self,
        texels: &DMatrix<f32>,
        sizes: Sizes,
        is_signed: bool,
        seed: u64,
        progress: &dyn Progress,
    ) -> Built {
        let [n_phi, n_theta, n_alpha, n_beta] =
            [self.grid.n_phi, self.grid.n_theta, self.grid.n_alpha, self.grid.n_beta].map(usize::from);
        let roots = self.roots();
        let slice_weights: Vec<f32> = roots.two.iter().map(|root| root * root).collect();
        let of_texels = Samples::new(texels.clone(), vec![1.0; texels.ncols()], is_signed);
        // 4-D: shapes of whole apparent BRDFs, in components.
        let mut shapes4 = of_texels.cluster(sizes.p4, ROUNDS, seed);
        let mut matches6 = of_texels.search(&shapes4);
        progress.advance(1);
        let mut before: Option<[Vec<Match>; 3]> = None;
        let mut built = None;
        for _ in 0..LOOPS {
            // Each level's vectors are the parts of the codewords above, and count as much as these.
            let tables = product(self.tables, &shapes4);
            let weights4 = counts(&matches6, &vec![1.0; texels.ncols()], shapes4.ncols());
            let weights: Vec<f32> = weights4.iter().flat_map(|weight| vec![*weight; n_phi]).collect();
            let level3 = Samples::new(parts(&tables, n_phi, &roots.three), weights, is_signed);
            let shapes3 = match &before {
                None => level3.cluster(sizes.p3, ROUNDS, seed + 1),
                Some([matches4, ..]) => level3.centroids(matches4, sizes.p3.min(level3.len())),
            };
            let matches4 = level3.search(&shapes3);
            progress.advance(1);
            let weights3 = counts(&matches4, &level3.weights, shapes3.ncols());
            let weights =
                weights3.iter().flat_map(|weight| roots.of_theta.iter().map(move |share| weight * share)).collect();
            let plain3 = unscaled(&shapes3, &roots.three);
            let level2 = Samples::new(parts(&plain3, n_theta, &roots.two), weights, is_signed);
            let shapes2 = match &before {
                None => level2.cluster(sizes.p2, ROUNDS, seed + 2),
                Some([_, matches3, _]) => level2.centroids(matches3, sizes.p2.min(level2.len())),
            };
            let matches3 = level2.search(&shapes2);
            progress.advance(1);
            let weights2 = counts(&matches3, &level2.weights, shapes2.ncols());
            let plain2 = unscaled(&shapes2, &roots.two);
            let level1 = Slices {
                nodes: n_beta,
                values: plain2.as_slice(),
                weights: weights2.iter().flat_map(|weight| vec![*weight; n_alpha]).collect(),
                node_weights: &slice_weights,
                is_signed,
            };
            let rows = match &before {
                None => level1.cluster(sizes.p1, ROUNDS),
                Some([.., matches2]) => level1.centroids(matches2, sizes.p1.min(level1.len())),
            };
            let p1 = to_bytes(&rows, n_beta, is_signed);
            let slices = DMatrix::from_vec(n_beta, p1.len() / (n_beta + 1), from_bytes(&p1, n_beta, is_signed));
            progress.advance(1);
            // Bottom-up: every level chooses among what those below it decode to.
            let matches2 = level1.search(slices.as_slice());
            let (scales2, p2) = quantised(&matches2, FINENESS[3], is_signed);
            let decoded2 = decoded(&slices, &p2, scales2, n_alpha, is_signed);
            let matches3 = level2.search(&scaled(&decoded2, &roots.two));
            let (scales3, p3) = quantised(&matches3, FINENESS[2], is_signed);
            let decoded3 = decoded(&decoded2, &p3, scales3, n_theta, is_signed);
            let matches4 = level3.search(&scaled(&decoded3, &roots.three));
            let (scales4, p4) = quantised(&matches4, FINENESS[1], is_signed);
            let decoded4 = decoded(&decoded3, &p4, scales4, n_phi, is_signed);
            let (projected, lengths) = self.project(&decoded4);
            matches6 = of_texels.search_among(&projected, &lengths);
            let (scales6, items) = quantised(&matches6, FINENESS[0], is_signed);
            let scales = [scales6, scales4, scales3, scales2];
            let chain = Chain { texels: items, p4, p3, p2, p1, scales, is_signed };
            built = Some(Built { chain, decoded: decoded4, projected });
            shapes4 = of_texels.centroids(&matches6, shapes4.ncols());
            before = Some([matches4, matches3, matches2]);
            progress.advance(1);
        }
        built.expect("there is a loop")
    }
}

impl Built {
    /// What of the texels' coefficients the stage leaves to later ones.
    pub(super) fn remainder(&self, texels: &DMatrix<f32>) -> DMatrix<f32> {
        let mut left = texels.clone();
        let scales = self.chain.scales[0];
        parallel::for_chunks(left.as_mut_slice(), texels.nrows(), |texel, left| {
            let item = &self.chain.texels[texel];
            let gain = gain(scales, item.code, self.chain.is_signed);
            for (left, value) in left.iter_mut().zip(self.projected.column(item.index as usize).iter()) {
                *left -= gain * value;
            }
        });
        left
    }
}

/// Σ w g² of the vectors that chose a codeword.
fn counts(matches: &[Match], weights: &[f32], count: usize) -> Vec<f32> {
    let mut sums = vec![0.0; count];
    for (found, weight) in matches.iter().zip(weights) {
        sums[found.index as usize] += weight * found.gain * found.gain;
    }
    sums
}

/// The parts of tables, `count` of each, times weights.
fn parts(tables: &DMatrix<f32>, count: usize, roots: &[f32]) -> DMatrix<f32> {
    let length = tables.nrows() / count;
    let values = tables.as_slice().iter().zip(roots.iter().cycle()).map(|(value, root)| value * root).collect();
    DMatrix::from_vec(length, tables.ncols() * count, values)
}

fn scaled(shapes: &DMatrix<f32>, roots: &[f32]) -> DMatrix<f32> {
    parts(shapes, 1, roots)
}

fn unscaled(shapes: &DMatrix<f32>, roots: &[f32]) -> DMatrix<f32> {
    let inverse: Vec<f32> = roots.iter().map(|root| 1.0 / root).collect();
    parts(shapes, 1, &inverse)
}

fn quantised(matches: &[Match], fineness: Fineness, is_signed: bool) -> (Scales, Vec<Item>) {
    let scales = scales(matches.iter().map(|found| found.gain), fineness, is_signed);
    let item = |found: &Match| Item { index: found.index, code: code(scales, found.gain, is_signed) };
    (scales, matches.iter().map(item).collect())
}

/// Entries of `count` items each, out of the codewords below.
fn decoded(below: &DMatrix<f32>, items: &[Item], scales: Scales, count: usize, is_signed: bool) -> DMatrix<f32> {
    let mut values = DMatrix::zeros(below.nrows() * count, items.len() / count);
    parallel::for_chunks(values.as_mut_slice(), below.nrows(), |number, out| {
        let item = &items[number];
        let gain = gain(scales, item.code, is_signed);
        for (out, value) in out.iter_mut().zip(below.column(item.index as usize).iter()) {
            *out = gain * value;
        }
    });
    values
}
