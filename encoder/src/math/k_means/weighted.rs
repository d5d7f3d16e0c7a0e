//! k-means of vectors whose values count differently.

use super::KMeans;
use crate::math::parallel;
use crate::math::side_by_side::{SideBySide, WIDTH};

/// Vectors of some dimensions, one after the other, with a weight for each value.
pub(crate) struct Weighted<'a> {
    pub(crate) dimensions: usize,
    pub(crate) values: &'a [f32],
    pub(crate) weights: &'a [f32],
}

impl Weighted<'_> {
    fn len(&self) -> usize {
        self.values.len() / self.dimensions
    }

    fn at(&self, number: usize) -> impl Iterator<Item = (f32, f32)> {
        let range = number * self.dimensions..(number + 1) * self.dimensions;
        self.values[range.clone()].iter().copied().zip(self.weights[range].iter().copied())
    }

    fn distance(&self, number: usize, centre: &[f32]) -> f32 {
        self.at(number).zip(centre).map(|((value, weight), centre)| weight * (value - centre) * (value - centre)).sum()
    }

    /// For every vector the centre where Σ w (x − c)² is least.
    pub(crate) fn nearest(&self, centres: &[f32]) -> Vec<u32> {
        let count = centres.len() / self.dimensions;
        let centres = SideBySide::new(centres, self.dimensions);
        let find = |number: usize| {
            let mut best = (0, f32::INFINITY);
            for (first, block) in centres.blocks() {
                let mut distances = [0.0; WIDTH];
                for ((value, weight), centre) in self.at(number).zip(block) {
                    for lane in 0..WIDTH {
                        distances[lane] += weight * (value - centre[lane]) * (value - centre[lane]);
                    }
                }
                for (index, distance) in (first..count).zip(distances) {
                    if distance < best.1 {
                        best = (index, distance);
                    }
                }
            }
            u32::try_from(best.0).expect("fewer than 2³² centres")
        };
        parallel::map(self.len(), find)
    }

    /// Mean weighted squared error, Σ w (x − c)² / Σ w.
    pub(crate) fn error(&self, centres: &[f32], nearest: &[u32]) -> f32 {
        let of = |(number, centre): (usize, &u32)| {
            self.distance(number, &centres[*centre as usize * self.dimensions..][..self.dimensions])
        };
        let errors: f32 = nearest.iter().enumerate().map(of).sum();
        errors * self.dimensions as f32 / self.weights.iter().sum::<f32>().max(f32::MIN_POSITIVE)
    }

    /// At most `count` centres and the sums of weights behind them, by `rounds` of Lloyd's iteration from vectors that
    /// are far from each other (Gonzalez 1985).
    pub(crate) fn cluster(&self, count: usize, rounds: usize) -> (Vec<f32>, Vec<f32>) {
        let start = Centres { values: self.scattered(count), weights: Vec::new() };
        let Centres { values, weights } = self.lloyd(start, rounds, |_| true);
        (values, weights)
    }

    fn scattered(&self, count: usize) -> Vec<f32> {
        let vector = |number: usize| &self.values[number * self.dimensions..(number + 1) * self.dimensions];
        let heaviest =
            |sizes: &[f32]| (0..sizes.len()).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]).then(b.cmp(a))).unwrap_or(0);
        let weight = |number: usize| self.at(number).map(|(_, weight)| weight).sum::<f32>();
        let weights: Vec<f32> = parallel::map(self.len(), weight);
        let mut centres = vector(heaviest(&weights)).to_vec();
        let mut distances = vec![f32::INFINITY; self.len()];
        while centres.len() < count * self.dimensions {
            let newest = centres[centres.len() - self.dimensions..].to_vec();
            distances = parallel::map(self.len(), |number| distances[number].min(self.distance(number, &newest)));
            let farthest = heaviest(&distances);
            if distances[farthest] <= 0.0 {
                break;
            }
            centres.extend_from_slice(vector(farthest));
        }
        centres
    }
}

/// Centres, and for each of their values the sum of the weights behind it.
pub(crate) struct Centres {
    values: Vec<f32>,
    weights: Vec<f32>,
}

impl KMeans for Weighted<'_> {
    type Codebook = Centres;
    type Assignment = Vec<u32>;

    fn assign(&self, centres: &Centres) -> Vec<u32> {
        self.nearest(&centres.values)
    }

    fn update(&self, nearest: &Vec<u32>, centres: &mut Centres) {
        let mut sums = vec![0.0; centres.values.len()];
        let mut means = vec![0.0; centres.values.len()];
        for (number, centre) in nearest.iter().enumerate() {
            let start = *centre as usize * self.dimensions;
            for (k, (value, weight)) in self.at(number).enumerate() {
                sums[start + k] += weight;
                means[start + k] += weight * value;
            }
        }
        for ((centre, mean), sum) in centres.values.iter_mut().zip(means).zip(&sums) {
            // What nothing weighs stays as it is.
            if *sum > 0.0 {
                *centre = mean / sum;
            }
        }
        centres.weights = sums;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clusters_are_found_and_weights_count() {
        let values: Vec<f32> = (0..60).map(|k| (k / 20) as f32 * 10.0 + (k % 2) as f32).collect();
        let mut weights = vec![1.0; 60];
        // The second value of the last vector counts for nothing.
        (weights[59], weights[58]) = (0.0, 3.0);
        let all = Weighted { dimensions: 2, values: &values, weights: &weights };
        let (centres, sums) = all.cluster(3, 5);
        let mut firsts: Vec<f32> = centres.iter().step_by(2).copied().collect();
        firsts.sort_by(f32::total_cmp);
        assert_eq!(firsts, [0.0, 10.0, 20.0]);
        assert!((sums.iter().sum::<f32>() - weights.iter().sum::<f32>()).abs() < 1e-4);
        assert!(all.error(&centres, &all.nearest(&centres)) < 1e-6);
        assert_eq!(all.cluster(40, 2).0.len(), 6, "there are three different vectors");
    }
}
