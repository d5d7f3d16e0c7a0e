//! Cells along half an axis, and what profiles are in them.

use super::profile::Radial;

use crate::math::parallel;

/// Cells along half an axis.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Grid {
    edges_mm: Vec<f64>,
}

impl Grid {
    /// `cells` cells from 0 to `radius_mm`, narrow where profiles are steep: edges at radius (i/n)².
    pub(crate) fn new(radius_mm: f64, cells: usize) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "cells are few")]
        let edge = |i: usize| radius_mm * (i as f64 / cells as f64).powi(2);
        Self { edges_mm: (0..=cells).map(edge).collect() }
    }

    /// `cells` cells of one width from 0 to `radius_mm`.
    pub(crate) fn even(radius_mm: f64, cells: usize) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "cells are few")]
        let edge = |i: usize| radius_mm * i as f64 / cells as f64;
        Self { edges_mm: (0..=cells).map(edge).collect() }
    }

    /// Number of cells.
    pub(crate) fn cells(&self) -> usize {
        self.edges_mm.len() - 1
    }

    /// Edges in mm, one more than cells; the first is 0.
    pub(crate) fn edges_mm(&self) -> &[f64] {
        &self.edges_mm
    }

    /// Radius that is covered, in mm.
    pub(crate) fn radius_mm(&self) -> f64 {
        self.edges_mm[self.cells()]
    }

    /// Widths h_i in mm.
    pub(crate) fn widths(&self) -> Vec<f64> {
        self.edges_mm.windows(2).map(|edges| edges[1] - edges[0]).collect()
    }

    /// Middles in mm.
    pub(crate) fn middles(&self) -> Vec<f64> {
        self.edges_mm.windows(2).map(|edges| 0.5 * (edges[0] + edges[1])).collect()
    }

    /// Means in the cells of a function whose integral from 0 is `to`.
    pub(crate) fn means(&self, to: impl Fn(f64) -> f64) -> Vec<f64> {
        let sums: Vec<f64> = self.edges_mm.iter().map(|edge| to(*edge)).collect();
        sums.windows(2).zip(self.widths()).map(|(sums, width)| (sums[1] - sums[0]) / width).collect()
    }

    /// Means of a profile in the cells of the plane's quarter `[i][j]`, in mm⁻².
    pub(crate) fn plane(&self, radial: &Radial) -> Vec<f64> {
        let count = self.edges_mm.len();
        // Symmetric: corners of one triangle are enough.
        let row = |i: usize| (0..=i).map(|j| radial.corner(self.edges_mm[i], self.edges_mm[j])).collect::<Vec<f64>>();
        let corners = parallel::map(count, row);
        let corner = |i: usize, j: usize| corners[i.max(j)][i.min(j)];
        let widths = self.widths();
        let cell = |i: usize, j: usize| {
            let sum = corner(i + 1, j + 1) - corner(i, j + 1) - corner(i + 1, j) + corner(i, j);
            sum / (widths[i] * widths[j])
        };
        (0..count - 1).flat_map(|i| (0..count - 1).map(move |j| (i, j))).map(|(i, j)| cell(i, j)).collect()
    }
}

/// Sum of separable terms A(x, y) = Σ s a(x) a(y) of one channel, each a even and constant in the cells of half an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Separable {
    pub(crate) grid: Grid,
    /// Signs s, and a in mm⁻¹ of the cells; the largest first.
    pub(crate) terms: Vec<(f64, Vec<f64>)>,
}

impl Separable {
    /// A(x, y) in mm⁻²; 0 beyond the radius along either axis.
    #[must_use]
    pub fn at(&self, x_mm: f64, y_mm: f64) -> f64 {
        let edges = self.grid.edges_mm();
        let cell =
            |x: f64| edges.partition_point(|edge| *edge <= x.abs()).checked_sub(1).filter(|i| *i < self.grid.cells());
        let (Some(i), Some(j)) = (cell(x_mm), cell(y_mm)) else { return 0.0 };
        self.terms.iter().map(|(sign, a)| sign * a[i] * a[j]).sum()
    }

    /// ∫ a over the whole axis, of each term.
    pub(crate) fn integrals(&self) -> Vec<f64> {
        let widths = self.grid.widths();
        let integral = |(_, a): &(f64, Vec<f64>)| 2.0 * a.iter().zip(&widths).map(|(a, width)| a * width).sum::<f64>();
        self.terms.iter().map(integral).collect()
    }

    /// ∫∫ A.
    pub(crate) fn energy(&self) -> f64 {
        self.terms.iter().zip(self.integrals()).map(|((sign, _), integral)| sign * integral * integral).sum()
    }

    /// Scales all terms so that ∫∫ A is `energy`. What has no positive energy cannot be, and stays.
    pub(crate) fn rescale(&mut self, energy: f64) {
        let own = self.energy();
        if own > 0.0 {
            let factor = (energy / own).sqrt();
            self.terms.iter_mut().flat_map(|(_, a)| a).for_each(|a| *a *= factor);
        }
    }

    /// A in the cells of the plane's quarter `[i][j]`, in mm⁻².
    pub(crate) fn plane(&self) -> Vec<f64> {
        let n = self.grid.cells();
        let at = |i: usize, j: usize| self.terms.iter().map(|(sign, a)| sign * a[i] * a[j]).sum();
        (0..n).flat_map(|i| (0..n).map(move |j| (i, j))).map(|(i, j)| at(i, j)).collect()
    }

    /// ∫_0^x a of term `t`; `sums` are [`Self::running`].
    pub(crate) fn to(&self, t: usize, sums: &[f64], x_mm: f64) -> f64 {
        let edges = self.grid.edges_mm();
        let x = x_mm.abs().min(self.grid.radius_mm());
        let cell = edges.partition_point(|edge| *edge <= x).saturating_sub(1).min(self.grid.cells() - 1);
        x_mm.signum() * (sums[cell] + (x - edges[cell]) * self.terms[t].1[cell])
    }

    /// ∫_0^edge a of term `t` at all edges.
    pub(crate) fn running(&self, t: usize) -> Vec<f64> {
        let widths = self.grid.widths();
        let mut sum = 0.0;
        let parts = self.terms[t].1.iter().zip(widths).map(|(a, width)| a * width);
        std::iter::once(0.0)
            .chain(parts.map(|part| {
                sum += part;
                sum
            }))
            .collect()
    }
}
