//! k-means of per-pixel profiles: the start of the direct method, and as "LSP clusters" a baseline of its own.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use crate::bssrdf::field::Field;
use crate::bssrdf::normal::Normal;
use crate::math::banded::Banded;
use crate::math::k_means::KMeans;
use crate::math::lanes::{self, Lanes, ZERO};
use crate::math::parallel;
use crate::progress::Progress;

/// Rounds of Lloyd's iteration, at most.
const ROUNDS: usize = 30;

/// Cluster centres `[cluster][node]` and the cluster of every pixel.
pub(crate) struct Clusters {
    pub(crate) centres: Vec<Lanes>,
    pub(crate) cluster_of: Vec<usize>,
}

/// Clusters the profiles of a field into at most `count` clusters: k-means++ (Arthur and Vassilvitskii 2007), then
/// Lloyd's rounds. The distance of two profiles is what their difference costs in eq. 5: (p − q)ᵀ A (p − q).
pub(crate) fn cluster(normal: &Normal, profiles: &Field, count: usize, seed: u64, progress: &dyn Progress) -> Clusters {
    let pixels = normal.geometry.pixels();
    let metric = normal.mean_matrix();
    progress.begin("clustering profiles", ROUNDS as u64);

    let first = first_centres(&metric, profiles, pixels, count, seed);
    let mut cluster_of = vec![0; pixels];
    let mut left = ROUNDS as u64;
    let centres = Profiles { metric: &metric, field: profiles, pixels }.lloyd(first, ROUNDS, |nearest| {
        let settled = nearest == cluster_of;
        cluster_of = nearest;
        let ends = settled || progress.stopped();
        let steps = if ends { left } else { 1 };
        progress.advance(steps);
        left -= steps;
        !ends
    });
    Clusters { centres, cluster_of }
}

/// The profiles of all pixels, to be clustered by what differences cost in eq. 5.
struct Profiles<'a> {
    metric: &'a Banded,
    field: &'a Field,
    pixels: usize,
}

impl KMeans for Profiles<'_> {
    /// Centres `[cluster][node]`.
    type Codebook = Vec<Lanes>;
    type Assignment = Vec<usize>;

    fn assign(&self, centres: &Vec<Lanes>) -> Vec<usize> {
        parallel::map(self.pixels, |pixel| nearest(self.metric, centres, self.field.at(pixel)).0)
    }

    /// Means; a centre that lost all its pixels stays where it is.
    fn update(&self, cluster_of: &Vec<usize>, centres: &mut Vec<Lanes>) {
        let nodes = self.metric.nodes();
        let mut sums = vec![[0.0_f64; 4]; centres.len()];
        let mut members = vec![0_u32; centres.len() / nodes];
        for (pixel, &cluster) in cluster_of.iter().enumerate() {
            members[cluster] += 1;
            for (sum, value) in sums[cluster * nodes..].iter_mut().zip(self.field.at(pixel)) {
                *sum = lanes::sum(*sum, value.map(f64::from));
            }
        }
        for (k, (centre, sum)) in centres.iter_mut().zip(&sums).enumerate() {
            let members = f64::from(members[k / nodes]);
            if members > 0.0 {
                #[allow(clippy::cast_possible_truncation, reason = "a mean of f32 values")]
                let mean = sum.map(|sum| (sum / members) as f32);
                *centre = mean;
            }
        }
    }
}

/// Seeds far apart: each next one drawn with probability proportional to its squared distance from those before.
fn first_centres(metric: &Banded, profiles: &Field, pixels: usize, count: usize, seed: u64) -> Vec<Lanes> {
    let mut rng = Pcg64::seed_from_u64(seed);
    let first = rng.random_range(0..pixels);
    let mut centres = profiles.at(first).to_vec();
    let mut distances = vec![f64::INFINITY; pixels];
    for _ in 1..count.min(pixels) {
        let newest = &centres[centres.len() - metric.nodes()..];
        distances =
            parallel::map(pixels, |pixel| distances[pixel].min(squared_distance(metric, newest, profiles.at(pixel))));
        let total: f64 = distances.iter().sum();
        if total <= 0.0 {
            // Fewer distinct profiles than clusters.
            break;
        }
        let mut rest = rng.random_range(0.0..total);
        let drawn = distances.iter().position(|distance| {
            rest -= distance;
            rest <= 0.0
        });
        let drawn = drawn.unwrap_or(pixels - 1);
        centres.extend_from_slice(profiles.at(drawn));
    }
    centres
}

/// Number and squared distance of the centre nearest to `profile`; of equals the first.
fn nearest(metric: &Banded, centres: &[Lanes], profile: &[Lanes]) -> (usize, f64) {
    let distances = centres.chunks(metric.nodes()).map(|centre| squared_distance(metric, centre, profile));
    let nearest = distances.enumerate().min_by(|a, b| a.1.total_cmp(&b.1));
    nearest.expect("there is at least one centre")
}

/// (p − q)ᵀ A (p − q) over all channels, A tridiagonal.
fn squared_distance(metric: &Banded, p: &[Lanes], q: &[Lanes]) -> f64 {
    let [d0, d1, _] = &metric.diagonals;
    let mut sum = ZERO;
    let mut before = ZERO;
    for h in 0..p.len() {
        for c in 0..4 {
            let difference = p[h][c] - q[h][c];
            let coupling = if h > 0 { 2.0 * d1[h - 1][c] * before[c] } else { 0.0 };
            sum[c] += difference * (d0[h][c] * difference + coupling);
            before[c] = difference;
        }
    }
    sum.iter().map(|value| f64::from(value.max(0.0))).sum()
}
