//! Components on the grid: tables whose interpolation is orthonormal where it was measured.

use nalgebra::DMatrix;

use crate::btf::resample::{Measured, Resampler};
use crate::math::eigen::Eigen;
use crate::math::matrix::transposed_product;
use crate::math::parallel;

/// Share of the largest eigenvalue that is added to all, where a few components cannot be told apart on the grid.
const RIDGE: f32 = 1e-4;

/// Interpolation from nodes to measured pairs, and the weights of these.
pub(super) struct Space<'a> {
    pub(super) measured: &'a Measured,
    /// Weight w of every pair of directions.
    pub(super) weights: &'a [f32],
}

/// Components, the most important first: a texel's value at a node is Σ_c coefficient · table, in one or two channels,
/// and errors of coefficients are errors of what was measured, in the units of the decomposition's.
pub(super) struct Components {
    /// For each channel, `[node × component]`.
    pub(super) tables: Vec<DMatrix<f32>>,
    /// Mean square of every component's coefficients.
    pub(super) energies: Vec<f32>,
}

impl Components {
    pub(super) fn count(&self) -> usize {
        self.energies.len()
    }
}

impl Space<'_> {
    /// Tables of basis functions that count weights, `[pair × component]`.
    fn fit(&self, resampler: &Resampler, basis: &DMatrix<f32>) -> DMatrix<f32> {
        let mut plain = basis.clone();
        for mut column in plain.column_iter_mut() {
            column.iter_mut().zip(self.weights).for_each(|(value, weight)| *value /= weight);
        }
        resampler.fit_all(&plain)
    }

    /// Tables as they are read at all pairs, times weights: `[pair × component]`.
    pub(super) fn read(&self, tables: &DMatrix<f32>) -> DMatrix<f32> {
        let read = |component: usize| {
            let mut values = self.measured.read(tables.column(component).as_slice());
            values.iter_mut().zip(self.weights).for_each(|(value, weight)| *value *= weight);
            values
        };
        let columns: Vec<Vec<f32>> = parallel::map(tables.ncols(), read);
        DMatrix::from_vec(self.weights.len(), columns.len(), columns.concat())
    }

    /// All components of `texels` (of the bases of each channel) as the grid shows them.
    pub(super) fn components(
        &self,
        resampler: &Resampler,
        bases: &[DMatrix<f32>],
        texels: &DMatrix<f32>,
    ) -> Components {
        let tables: Vec<DMatrix<f32>> = bases.iter().map(|basis| self.fit(resampler, basis)).collect();
        let rank = texels.nrows();
        if rank == 0 {
            return Components { tables, energies: Vec::new() };
        }
        let (metric, cross) = self.products(&tables, bases);
        let lower = metric.cholesky().expect("it is positive: a ridge was added").l();
        // z = Lᵀ M⁻¹ C u = L⁻¹ C u has the metric 1.
        let inverse = lower.solve_lower_triangular(&DMatrix::identity(rank, rank)).expect("its diagonal is positive");
        let z = &inverse * cross * texels;
        let eigen = Eigen::of(&z * z.transpose() / texels.ncols() as f32);
        let nodes_from_components = inverse.transpose() * &eigen.vectors;
        Components {
            tables: tables.iter().map(|table| table * &nodes_from_components).collect(),
            energies: eigen.values.iter().map(|value| value.max(0.0)).collect(),
        }
    }

    /// The coefficients that come closest to texels of the bases, for tables as they will be decoded.
    pub(super) fn coefficients(
        &self,
        tables: &[DMatrix<f32>],
        bases: &[DMatrix<f32>],
        texels: &DMatrix<f32>,
    ) -> DMatrix<f32> {
        if tables[0].ncols() == 0 {
            return DMatrix::zeros(0, texels.ncols());
        }
        let (metric, cross) = self.products(tables, bases);
        metric.cholesky().expect("it is positive: a ridge was added").solve(&(cross * texels))
    }

    /// Σ RᵀR and Σ RᵀB over channels, R the tables as they are read.
    fn products(&self, tables: &[DMatrix<f32>], bases: &[DMatrix<f32>]) -> (DMatrix<f32>, DMatrix<f32>) {
        let count = tables[0].ncols();
        let mut metric = DMatrix::zeros(count, count);
        let mut cross = DMatrix::zeros(count, bases[0].ncols());
        for (table, basis) in tables.iter().zip(bases) {
            let read = self.read(table);
            metric += transposed_product(&read, &read);
            cross += transposed_product(&read, basis);
        }
        let ridge = RIDGE * metric.diagonal().max() + f32::MIN_POSITIVE;
        (metric + DMatrix::identity(count, count) * ridge, cross)
    }
}
