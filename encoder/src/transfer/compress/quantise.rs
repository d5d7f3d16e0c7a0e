//! Means, components and coefficients in few bits.

use nalgebra::{DMatrix, DMatrixView, DVector};
use subsurf_decoder::transfer::layout::{MAX_BITS, MAX_COMPONENTS};

use super::cpca::{Clusters, Projected};
use super::signed;
use crate::math::parallel;
use crate::math::uniform::{OffsetStep, codes};
use crate::transfer::rd_table::single;

/// Clusters as files have them.
pub(in crate::transfer) struct Quantised {
    /// Largest value of each channel, by which all was divided.
    pub(in crate::transfer) scales: Vec<f32>,
    /// Bits of each component.
    pub(in crate::transfer) bits: [u8; MAX_COMPONENTS],
    /// Axes `[value][axis]`.
    pub(in crate::transfer) axes: Vec<i8>,
    /// Ranges `[cluster][mean, components]`.
    pub(in crate::transfer) ranges: Vec<OffsetStep>,
    /// Means `[cluster][axis]`.
    pub(in crate::transfer) means: Vec<u16>,
    /// Components `[cluster][component][axis]`.
    pub(in crate::transfer) components: Vec<i8>,
    /// Cluster of each place, and codes `[component]` of its coefficients.
    pub(in crate::transfer) places: Vec<(u8, [u16; MAX_COMPONENTS])>,
}

/// A cluster in few bits, with the exact coefficients of its members to these components.
struct Cluster {
    mean: (OffsetStep, Vec<u16>),
    components: Vec<Vec<i8>>,
    members: Vec<usize>,
    /// `[component × member]`.
    coefficients: DMatrix<f32>,
    /// Square lengths of the components.
    squares: Vec<f32>,
}

impl Quantised {
    /// q divided by `scales` along axes, in clusters, with `bits` for the coefficients of a place.
    pub(super) fn new(q: Projected, scales: Vec<f32>, clusters: &Clusters, bits: usize) -> Self {
        let mut members = vec![Vec::new(); clusters.components.len()];
        for (place, cluster) in clusters.chosen.iter().enumerate() {
            members[usize::from(*cluster)].push(place);
        }
        let clusters = parallel::map(members.len(), |number| {
            let mean = clusters.means.column(number).into_owned();
            Cluster::new(&q, &members[number], &mean, &clusters.components[number])
        });
        let count = clusters[0].components.len();
        let bits = shared(&clusters, count, bits);
        let mut out = Self {
            scales,
            bits,
            ranges: Vec::new(),
            means: Vec::new(),
            components: Vec::new(),
            places: vec![(0, [0; MAX_COMPONENTS]); q.columns.ncols()],
            axes: q.axes,
        };
        for (number, cluster) in (0..=u8::MAX).zip(&clusters) {
            out.ranges.push(cluster.mean.0);
            out.means.extend(&cluster.mean.1);
            for (k, row) in cluster.coefficients.row_iter().enumerate() {
                let most = (1_u16 << bits[k]) - 1;
                let (range, codes) = codes(row.iter().copied(), most);
                out.ranges.push(range);
                for (place, code) in cluster.members.iter().zip(codes) {
                    out.places[*place].0 = number;
                    out.places[*place].1[k] = code;
                }
            }
            out.components.extend(cluster.components.iter().flatten());
        }
        out
    }
}

impl Cluster {
    /// Mean and components are along the basis of q; those of files are along its axes.
    fn new(q: &Projected, members: &[usize], mean: &DVector<f32>, exact: &DMatrix<f32>) -> Self {
        let axes = &q.axes_of_basis;
        let mean = codes(least_squares(axes, mean.as_view()).column(0).iter().copied(), u16::MAX);
        let [offset, step] = mean.0;
        let codes = mean.1.iter().map(|code| offset + step * f32::from(*code));
        let rounded_mean = axes * DVector::from_iterator(axes.ncols(), codes);
        let along = least_squares(axes, exact.as_view());
        let components: Vec<Vec<i8>> = along.column_iter().map(|column| signed(column.as_slice())).collect();
        let rounded = DMatrix::from_fn(axes.ncols(), components.len(), |row, k| f32::from(components[k][row]));
        let rounded = axes * rounded;
        let mut rest = q.columns.select_columns(members);
        rest.column_iter_mut().for_each(|mut column| column -= &rounded_mean);
        // Least squares to the rounded components, which are not quite orthogonal.
        let coefficients = least_squares(&rounded, rest.as_view());
        let squares = rounded.column_iter().map(|column| column.norm_squared()).collect();
        Self { mean, components, members: members.to_vec(), coefficients, squares }
    }
}

/// Least squares of columns by the columns of `matrix`; those that are zero get nothing.
fn least_squares(matrix: &DMatrix<f32>, columns: DMatrixView<'_, f32>) -> DMatrix<f32> {
    let mut gram = matrix.tr_mul(matrix).map(f64::from);
    let ridge = 1e-9 * gram.trace().max(1e-9);
    for k in 0..gram.nrows() {
        gram[(k, k)] += ridge;
    }
    let along = matrix.tr_mul(&columns).map(f64::from);
    gram.cholesky().expect("it is positive: a ridge was added").solve(&along).map(single)
}

/// Bits of each component, all but one given to where they help most: the largest rms of range · length / 2^bits.
fn shared(clusters: &[Cluster], count: usize, total: usize) -> [u8; MAX_COMPONENTS] {
    let error = |k: usize| {
        let of = |cluster: &Cluster| {
            let row = cluster.coefficients.row(k);
            let width = if row.is_empty() { 0.0 } else { row.max() - row.min() };
            f64::from(width * width * cluster.squares[k]) * row.len() as f64
        };
        clusters.iter().map(of).sum::<f64>()
    };
    let errors: Vec<f64> = (0..count).map(error).collect();
    let mut bits = [0; MAX_COMPONENTS];
    bits[..count].fill(1);
    for _ in count..total {
        let left = |k: &usize| errors[*k] / 4.0_f64.powi(bits[*k].into());
        let open = (0..count).filter(|k| bits[*k] < MAX_BITS);
        if let Some(k) = open.max_by(|a, b| left(a).total_cmp(&left(b)).then(b.cmp(a))) {
            bits[k] += 1;
        }
    }
    bits
}
