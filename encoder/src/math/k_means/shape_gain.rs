//! Shape-gain vector quantisation: vectors as codewords of unit length times a gain (Gersho and Gray 1992, section 12.10).

use nalgebra::DMatrix;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::KMeans;
use crate::math::argmax::argmax;
use crate::math::eigen;
use crate::math::matrix::product;
use crate::math::parallel;

/// Vectors that are multiplied at a time.
const BLOCK: usize = 512;
/// Dimensions that are left where searches are in fewer than all.
const REDUCED: usize = 64;

/// The best codeword of a vector, and the gain that brings it closest.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Match {
    pub(crate) index: u32,
    pub(crate) gain: f32,
}

/// Vectors in their columns, and what each counts.
pub(crate) struct Samples {
    pub(crate) vectors: DMatrix<f32>,
    pub(crate) weights: Vec<f32>,
    /// Whether gains may be negative.
    pub(crate) is_signed: bool,
    /// The vectors in the dimensions in which they differ most, and the way there.
    reduced: Option<(DMatrix<f32>, DMatrix<f32>)>,
}

impl Samples {
    pub(crate) fn new(vectors: DMatrix<f32>, weights: Vec<f32>, is_signed: bool) -> Self {
        // Of few vectors, all dimensions are compared sooner than the best are found.
        let is_worth_it = vectors.nrows() > 2 * REDUCED && vectors.ncols() > vectors.nrows();
        let reduced = is_worth_it.then(|| {
            let axes = leading_axes(&vectors, &weights);
            (product(&axes.transpose(), &vectors), axes)
        });
        Self { vectors, weights, is_signed, reduced }
    }

    pub(crate) fn len(&self) -> usize {
        self.vectors.ncols()
    }

    /// For every vector the codeword, a column, that leaves the smallest remainder, and its gain. Codewords of any
    /// length; those of length zero are never chosen. Where vectors are long, in the dimensions that count most.
    pub(crate) fn search(&self, codewords: &DMatrix<f32>) -> Vec<Match> {
        let lengths: Vec<f32> = codewords.column_iter().map(|word| word.norm()).collect();
        match &self.reduced {
            Some((vectors, axes)) => self.among(vectors, &product(&axes.transpose(), codewords), &lengths),
            None => self.among(&self.vectors, codewords, &lengths),
        }
    }

    /// [`Self::search`] of codewords that are longer than what the vectors' dimensions show of them.
    pub(crate) fn search_among(&self, codewords: &DMatrix<f32>, lengths: &[f32]) -> Vec<Match> {
        self.among(&self.vectors, codewords, lengths)
    }

    fn among(&self, vectors: &DMatrix<f32>, codewords: &DMatrix<f32>, lengths: &[f32]) -> Vec<Match> {
        let inverse_lengths: Vec<f32> =
            lengths.iter().map(|length| if *length > 0.0 { 1.0 / length } else { 0.0 }).collect();
        let mut transposed = codewords.transpose();
        for (mut row, inverse) in transposed.row_iter_mut().zip(&inverse_lengths) {
            row *= *inverse;
        }
        let starts: Vec<usize> = (0..self.len()).step_by(BLOCK).collect();
        let block = |start: usize| {
            let count = BLOCK.min(self.len() - start);
            let scores = &transposed * vectors.columns(start, count);
            scores.column_iter().map(|scores| self.best(scores.as_slice(), &inverse_lengths)).collect::<Vec<_>>()
        };
        parallel::map(starts.len(), |k| block(starts[k])).concat()
    }

    /// The largest score, which is the length of a vector along a codeword.
    fn best(&self, scores: &[f32], inverse_lengths: &[f32]) -> Match {
        let of_word = |size: f32, inverse: f32| if inverse > 0.0 { size } else { f32::NEG_INFINITY };
        let best = if self.is_signed {
            argmax(scores, inverse_lengths, |score, inverse| of_word(score.abs(), inverse))
        } else {
            argmax(scores, inverse_lengths, of_word)
        };
        let gain = scores[best] * inverse_lengths[best];
        let index = u32::try_from(best).expect("fewer than 2³² codewords");
        Match { index, gain: if self.is_signed { gain } else { gain.max(0.0) } }
    }

    /// Codewords of unit length, each along Σ w g x of the vectors that chose it; those that none chose are made of the
    /// vectors that are farthest from theirs.
    pub(crate) fn centroids(&self, matches: &[Match], count: usize) -> DMatrix<f32> {
        let mut members = vec![Vec::new(); count];
        for (sample, found) in matches.iter().enumerate() {
            members[found.index as usize].push(sample);
        }
        let dimensions = self.vectors.nrows();
        let mut shapes = DMatrix::zeros(dimensions, count);
        parallel::for_chunks(shapes.as_mut_slice(), dimensions, |number, shape| {
            for &sample in &members[number] {
                let weight = self.weights[sample] * matches[sample].gain;
                for (sum, value) in shape.iter_mut().zip(self.vectors.column(sample).iter()) {
                    *sum += weight * value;
                }
            }
            normalise(shape);
        });
        let empty: Vec<usize> = (0..count).filter(|shape| shapes.column(*shape).norm() == 0.0).collect();
        if !empty.is_empty() {
            for (shape, sample) in empty.into_iter().zip(self.farthest(matches, &shapes)) {
                shapes.set_column(shape, &self.vectors.column(sample));
                normalise(shapes.column_mut(shape).as_mut_slice());
            }
        }
        shapes
    }

    /// Samples by what is left of them, the most first.
    fn farthest(&self, matches: &[Match], shapes: &DMatrix<f32>) -> Vec<usize> {
        let left = |sample: usize| {
            let (vector, found) = (self.vectors.column(sample), matches[sample]);
            let along = vector.dot(&shapes.column(found.index as usize));
            self.weights[sample] * (vector.norm_squared() - along * along)
        };
        let mut order: Vec<(f32, usize)> = parallel::map(self.len(), |sample| (left(sample), sample));
        order.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        order.into_iter().map(|(_, sample)| sample).collect()
    }

    /// `count` codewords by `rounds` of Lloyd's iteration; fewer if there are not as many vectors.
    pub(crate) fn cluster(&self, count: usize, rounds: usize, seed: u64) -> DMatrix<f32> {
        let count = count.min(self.len()).max(1);
        self.lloyd(self.first(count, seed), rounds, |_| true)
    }

    /// Vectors drawn by w |x|², each once.
    fn first(&self, count: usize, seed: u64) -> DMatrix<f32> {
        let mut rng = Pcg64::seed_from_u64(seed);
        // The smallest of exponential variates divided by their weights (Efraimidis and Spirakis 2006).
        let mut keys: Vec<(f64, usize)> = (0..self.len())
            .map(|sample| {
                let weight = f64::from(self.weights[sample]) * f64::from(self.vectors.column(sample).norm_squared());
                let variate = -(1.0 - rng.random::<f64>()).ln();
                (variate / weight.max(1e-30), sample)
            })
            .collect();
        keys.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut shapes = DMatrix::zeros(self.vectors.nrows(), count);
        for (shape, (_, sample)) in keys.iter().take(count).enumerate() {
            shapes.set_column(shape, &self.vectors.column(*sample));
            normalise(shapes.column_mut(shape).as_mut_slice());
        }
        shapes
    }
}

impl KMeans for Samples {
    /// Codewords in the columns.
    type Codebook = DMatrix<f32>;
    type Assignment = Vec<Match>;

    fn assign(&self, codewords: &DMatrix<f32>) -> Vec<Match> {
        self.search(codewords)
    }

    fn update(&self, matches: &Vec<Match>, codewords: &mut DMatrix<f32>) {
        *codewords = self.centroids(matches, codewords.ncols());
    }
}

/// Makes a vector's length 1, unless it is 0.
fn normalise(vector: &mut [f32]) {
    let length = vector.iter().map(|value| value * value).sum::<f32>().sqrt();
    if length > 0.0 {
        vector.iter_mut().for_each(|value| *value /= length);
    }
}

/// The leading axes of Σ w x xᵀ.
fn leading_axes(vectors: &DMatrix<f32>, weights: &[f32]) -> DMatrix<f32> {
    let starts: Vec<usize> = (0..vectors.ncols()).step_by(BLOCK).collect();
    let gram = |start: &usize| {
        let mut part = vectors.columns(*start, BLOCK.min(vectors.ncols() - start)).into_owned();
        for (mut column, weight) in part.column_iter_mut().zip(&weights[*start..]) {
            column *= weight.sqrt();
        }
        &part * part.transpose()
    };
    // A fixed number of shares, added in order: the same on any number of threads.
    let shares: Vec<&[usize]> = starts.chunks(starts.len().div_ceil(8)).collect();
    let shares =
        parallel::map(shares.len(), |k| shares[k].iter().map(gram).reduce(|a, b| a + b).expect("no share is empty"));
    let gram = shares.into_iter().reduce(|a, b| a + b).expect("there are vectors");
    eigen::leading_axes(gram, REDUCED)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shapes_are_found_whatever_their_gains() {
        let shape = |k: usize, d: usize| ((d * (k + 1)) as f32 * 0.7 + k as f32).sin();
        let vectors = DMatrix::from_fn(20, 400, |d, x| shape(x % 5, d) * (1.0 + (x % 17) as f32));
        let samples = Samples::new(vectors.clone(), vec![1.0; 400], false);
        // More codewords than shapes: the first ones drawn may share a shape.
        let shapes = samples.cluster(20, 10, 3);
        let found = samples.search(&shapes);
        for (x, found) in found.iter().enumerate() {
            let left = vectors.column(x) - shapes.column(found.index as usize) * found.gain;
            assert!(left.norm() < 1e-3 * vectors.column(x).norm(), "vector {x}");
        }
    }

    #[test]
    fn signs_are_gains() {
        let vectors = DMatrix::from_fn(4, 6, |d, x| (d as f32 + 1.0) * if x % 2 == 0 { 2.0 } else { -3.0 });
        let samples = Samples::new(vectors, vec![1.0; 6], true);
        let shapes = samples.cluster(1, 3, 0);
        let gains: Vec<f32> = samples.search(&shapes).iter().map(|found| found.gain).collect();
        assert!((gains[0] / gains[1] + 2.0 / 3.0).abs() < 1e-4, "{gains:?}");
    }

    #[test]
    fn long_vectors_are_searched_in_fewer_dimensions() {
        let shape = |k: usize, d: usize| ((d * (k + 1)) as f32 * 0.013 + k as f32).sin();
        let vectors = DMatrix::from_fn(400, 700, |d, x| shape(x % 30, d));
        let samples = Samples::new(vectors, vec![1.0; 700], false);
        let words = DMatrix::from_fn(400, 30, |d, k| 2.0 * shape(k, d));
        for (x, found) in samples.search(&words).iter().enumerate() {
            assert_eq!(found.index as usize, x % 30);
            assert!((found.gain - 0.5).abs() < 0.02, "{found:?}");
        }
    }
}
