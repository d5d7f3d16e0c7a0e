//! Clusters of vertices with principal components of their own (Kambhatla and Leen 1997, *Dimension reduction by local principal
//! component analysis*; for transfer Sloan et al. 2003, *Clustered principal components for precomputed radiance transfer*).

use nalgebra::{DMatrix, DVector};

use super::Size;
use super::signed;
use crate::math::eigen::leading_axes;
use crate::math::k_means::KMeans;
use crate::math::k_means::euclidean::Euclidean;
use crate::math::matrix::{orthonormal, product};
use crate::math::parallel;
use crate::math::svd::Columns;
use crate::progress::Progress;

/// Leading dimensions by which k-means tells vertices apart.
const LEADING: usize = 64;
/// Vertices that clusters are first found among.
const SAMPLE: usize = 40_000;
/// Rounds of k-means, which only has to begin.
const K_MEANS_ROUNDS: usize = 8;
/// Rounds of fitting and assigning on the sample, and on all.
const ROUNDS: [usize; 2] = [7, 2];
/// Vertices that one thread assigns at a time.
const BLOCK: usize = 64;

/// Columns of q along few axes.
pub(super) struct Projected {
    /// Axes as files have them, signed bytes `[value][axis]`; not quite orthogonal.
    pub(super) axes: Vec<i8>,
    /// The same axes along an orthonormal basis of their span, `[dimension × axis]`.
    pub(super) axes_of_basis: DMatrix<f32>,
    /// Columns along that basis, `[dimension × column]`.
    pub(super) columns: DMatrix<f32>,
}

/// Clusters of the columns of a matrix.
pub(super) struct Clusters {
    /// Cluster of each column.
    pub(super) chosen: Vec<u8>,
    /// Means `[dimension × cluster]`.
    pub(super) means: DMatrix<f32>,
    /// Orthonormal components of each cluster, `[dimension × component]`.
    pub(super) components: Vec<DMatrix<f32>>,
}

impl Projected {
    /// The columns of `q` along the axes in which they are longest, at most as many as q has values.
    pub(super) fn new(q: &DMatrix<f32>, count: usize) -> Self {
        // Sums of parts in a fixed order, whatever the threads.
        let part = |number: usize| {
            let first = number * SAMPLE;
            let part = q.columns(first, SAMPLE.min(q.ncols() - first));
            part * part.transpose()
        };
        let parts = parallel::map(q.ncols().div_ceil(SAMPLE), part);
        let zero = DMatrix::zeros(q.nrows(), q.nrows());
        let exact = leading_axes(parts.iter().fold(zero, |sum, part| sum + part), count);
        let bytes: Vec<Vec<i8>> = exact.column_iter().map(|axis| signed(axis.as_slice())).collect();
        let rounded = DMatrix::from_fn(q.nrows(), bytes.len(), |value, axis| f32::from(bytes[axis][value]));
        let basis = orthonormal(rounded.clone()).transpose();
        let axes = (0..q.nrows()).flat_map(|value| bytes.iter().map(move |axis| axis[value])).collect();
        Self { axes, axes_of_basis: &basis * rounded, columns: product(&basis, q) }
    }

    /// Clusters and components that leave the least of the columns over.
    pub(super) fn cluster(&self, size: &Size, progress: &dyn Progress) -> Clusters {
        let count = self.columns.ncols();
        let sample: Vec<usize> = (0..count).step_by(count.div_ceil(SAMPLE)).collect();
        let sample = self.columns.select_columns(&sample);
        progress.begin("clusters of vertices", (ROUNDS[0] + ROUNDS[1] + 1) as u64);
        let mut chosen = begin(&sample, size.clusters);
        let mut local = Local::fit(&sample, &chosen, size);
        for _ in 0..ROUNDS[0] {
            chosen = local.assign(&sample);
            local = Local::fit(&sample, &chosen, size);
            progress.advance(1);
        }
        for _ in 0..ROUNDS[1] {
            chosen = local.assign(&self.columns);
            local = Local::fit(&self.columns, &chosen, size);
            progress.advance(1);
        }
        let chosen = local.assign(&self.columns);
        progress.advance(1);
        Clusters { chosen, means: local.means, components: local.components }
    }
}

/// Cluster of each column by k-means in the leading dimensions.
fn begin(columns: &DMatrix<f32>, clusters: usize) -> Vec<u8> {
    let leading = LEADING.min(columns.nrows());
    let step = columns.ncols().div_ceil(clusters);
    let first: Vec<usize> = (0..columns.ncols()).step_by(step).collect();
    let words = columns.select_columns(&first).rows(0, leading).into_owned();
    let all = Euclidean(columns);
    let words = all.lloyd(words, K_MEANS_ROUNDS, |_| true);
    all.assign(&words).into_iter().map(|(word, _)| word).collect()
}

/// Means and components along the basis of the axes.
struct Local {
    means: DMatrix<f32>,
    components: Vec<DMatrix<f32>>,
}

impl Local {
    /// Means and leading components of the columns of every cluster; of clusters without columns zeros.
    fn fit(columns: &DMatrix<f32>, chosen: &[u8], size: &Size) -> Self {
        let mut members = vec![Vec::new(); size.clusters];
        for (column, cluster) in chosen.iter().enumerate() {
            members[usize::from(*cluster)].push(column);
        }
        let of_cluster = |cluster: usize| {
            let members = &members[cluster];
            let mut own = columns.select_columns(members);
            let none = DMatrix::zeros(columns.nrows(), size.components);
            if members.is_empty() {
                return (DVector::zeros(columns.nrows()), none);
            }
            let mean = own.column_mean();
            own.column_iter_mut().for_each(|mut column| column -= &mean);
            (mean, leading(&own, none))
        };
        let (means, components): (Vec<DVector<f32>>, Vec<_>) =
            parallel::map(members.len(), of_cluster).into_iter().unzip();
        Self { means: DMatrix::from_columns(&means), components }
    }

    /// The cluster of each column that leaves the least of it over: ‖y − m‖² − Σ_k ((y − m) · v_k)².
    fn assign(&self, columns: &DMatrix<f32>) -> Vec<u8> {
        let rows = self.components[0].ncols() + 1;
        // Of each cluster its mean and its components, in rows.
        let mut all = DMatrix::zeros(rows * self.components.len(), columns.nrows());
        let mut own = Vec::with_capacity(self.components.len());
        for (cluster, components) in self.components.iter().enumerate() {
            let mean = self.means.column(cluster);
            all.row_mut(cluster * rows).tr_copy_from(&mean);
            for (k, component) in components.column_iter().enumerate() {
                all.row_mut(cluster * rows + 1 + k).tr_copy_from(&component);
            }
            own.push((mean.norm_squared(), components.tr_mul(&mean)));
        }
        let best = |products: &[f32]| {
            let rest = |((norm, along), products): (&(f32, DVector<f32>), &[f32])| {
                let explained = products[1..].iter().zip(along).map(|(y, m)| (y - m) * (y - m)).sum::<f32>();
                norm - 2.0 * products[0] - explained
            };
            let rests = own.iter().zip(products.chunks_exact(rows)).map(rest).enumerate();
            let (cluster, _) = rests.fold((0, f32::INFINITY), |best, next| if next.1 < best.1 { next } else { best });
            u8::try_from(cluster).expect("at most 256 clusters")
        };
        let of_block = |block: usize| {
            let first = block * BLOCK;
            let products = &all * columns.columns(first, BLOCK.min(columns.ncols() - first));
            products.as_slice().chunks_exact(products.nrows()).map(best).collect::<Vec<_>>()
        };
        parallel::map(columns.ncols().div_ceil(BLOCK), of_block).concat()
    }
}

/// The leading principal components of centred columns; the last are zeros where there are fewer.
fn leading(columns: &DMatrix<f32>, mut out: DMatrix<f32>) -> DMatrix<f32> {
    let fill = |column: usize, out: &mut [f32]| out.copy_from_slice(columns.column(column).as_slice());
    let found =
        Columns { rows: columns.nrows(), columns: columns.ncols(), group: 1, fill }.decompose(out.ncols(), 1, &());
    for (mut component, row) in out.column_iter_mut().zip(found.texels.row_iter()) {
        let norm = row.norm();
        if norm > 0.0 {
            component.tr_copy_from(&(row / norm));
        }
    }
    out
}
