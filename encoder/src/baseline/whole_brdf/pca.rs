//! Clusters of texels, and principal components inside of them.

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::space::Whole;
use super::{Baseline, Part, bits, signed_columns, signed_rows};
use crate::btf::TruncatedSvd;
use crate::math::eigen::Eigen;
use crate::math::k_means::KMeans;
use crate::math::k_means::euclidean::Euclidean;

/// Rounds of k-means.
const ROUNDS: usize = 20;
/// Rounds of choosing clusters by what their components leave over.
const LOCAL_ROUNDS: usize = 8;

/// Means `[coordinate × cluster]`, and the cluster of every column.
pub(super) fn k_means(columns: &DMatrix<f32>, clusters: usize, seed: u64) -> (DMatrix<f32>, Vec<u8>) {
    let mut rng = Pcg64::seed_from_u64(seed);
    let vectors = Euclidean(columns);
    // The first means are columns far from each other (Arthur and Vassilvitskii 2007).
    let mut found = columns.columns(rng.random_range(0..columns.ncols()), 1).into_owned();
    while found.ncols() < clusters {
        let distances: Vec<f32> = vectors.assign(&found).into_iter().map(|(_, distance)| distance.max(0.0)).collect();
        let mut left = rng.random::<f32>() * distances.iter().sum::<f32>();
        let drawn = distances.iter().position(|distance| {
            left -= distance;
            left < 0.0
        });
        let next = found.ncols();
        found = found.insert_column(next, 0.0);
        found.column_mut(next).copy_from(&columns.column(drawn.unwrap_or(0)));
    }
    let found = vectors.lloyd(found, ROUNDS, |_| true);
    let chosen = vectors.assign(&found).into_iter().map(|(cluster, _)| cluster).collect();
    (found, chosen)
}

/// The leading eigenvectors of columns' second moments, `[coordinate × component]`.
pub(super) fn principal(columns: &DMatrix<f32>, components: usize) -> DMatrix<f32> {
    Eigen::of(columns * columns.transpose()).leading(components)
}

/// Bytes of [`local_pca`].
#[must_use]
pub fn local_pca_bytes(clusters: usize, components: usize, texels: usize, pairs: usize) -> u64 {
    // Means and functions in 8 bits with a step each, coefficients in 8 bits, with a step for each component.
    let functions = clusters * ((components + 1) * (3 * pairs + 4) + components * 4);
    (functions + texels * components + (texels * bits(clusters)).div_ceil(8)) as u64
}

/// Clusters of texels with a mean and principal components of their own (Müller, Meseth and Klein 2003), functions and
/// coefficients in 8 bits.
#[must_use]
pub fn local_pca(svd: &TruncatedSvd, clusters: usize, components: usize, seed: u64) -> Baseline {
    let whole = Whole::new(svd);
    let texels = &whole.texels;
    let (_, mut part_of) = k_means(texels, clusters, seed);
    let mut of_clusters = Vec::new();
    for _ in 0..LOCAL_ROUNDS {
        of_clusters = (0..clusters).map(|cluster| Local::new(texels, &part_of, cluster, components)).collect();
        let errors: Vec<Vec<f32>> = of_clusters.iter().map(|local: &Local| local.errors(texels)).collect();
        for (texel, part) in (0..).zip(&mut part_of) {
            let best = (0..clusters).min_by(|a, b| errors[*a][texel].total_cmp(&errors[*b][texel]));
            *part = u8::try_from(best.unwrap_or(0)).expect("at most 256 clusters");
        }
    }
    let part = |local: &Local| {
        let mut functions = whole.functions(&local.functions());
        let mut coefficients = local.coefficients(texels);
        signed_columns(&mut functions);
        signed_rows(&mut coefficients);
        // The mean is not multiplied by anything.
        let coefficients = coefficients.insert_row(0, 1.0);
        Part { functions, coefficients }
    };
    Baseline {
        bytes: local_pca_bytes(clusters, components, svd.texels(), svd.weights.len()),
        tone: svd.tone,
        parts: of_clusters.iter().map(part).collect(),
        part_of,
    }
}

/// Mean and axes of one cluster.
struct Local {
    mean: DVector<f32>,
    axes: DMatrix<f32>,
}

impl Local {
    fn new(texels: &DMatrix<f32>, part_of: &[u8], cluster: usize, components: usize) -> Self {
        let members: Vec<usize> =
            part_of.iter().enumerate().filter(|(_, part)| usize::from(**part) == cluster).map(|(k, _)| k).collect();
        // A cluster that nothing chose stays with the first texel.
        let mut own = texels.select_columns(if members.is_empty() { &[0] } else { &members[..] });
        let mean = own.column_mean();
        own.column_iter_mut().for_each(|mut column| column -= &mean);
        Self { axes: principal(&own, components), mean }
    }

    fn coefficients(&self, texels: &DMatrix<f32>) -> DMatrix<f32> {
        let mut found = self.axes.tr_mul(texels);
        let of_mean = self.axes.tr_mul(&self.mean);
        found.column_iter_mut().for_each(|mut column| column -= &of_mean);
        found
    }

    fn errors(&self, texels: &DMatrix<f32>) -> Vec<f32> {
        let coefficients = self.coefficients(texels);
        let kept = coefficients.column_iter().map(|column| column.norm_squared());
        texels.column_iter().zip(kept).map(|(texel, kept)| (texel - &self.mean).norm_squared() - kept).collect()
    }

    /// Functions of the mean and of the axes, in columns.
    fn functions(&self) -> DMatrix<f32> {
        let mut all = DMatrix::zeros(self.mean.len(), self.axes.ncols() + 1);
        all.column_mut(0).copy_from(&self.mean);
        all.columns_mut(1, self.axes.ncols()).copy_from(&self.axes);
        all
    }
}
