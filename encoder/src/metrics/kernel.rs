//! Errors of separable kernels against the exact convolution in the plane.

use std::f64::consts::PI;

use crate::kernel::grid::{Grid, Separable};
use crate::kernel::profile::Radial;

/// Share of the light by whose radius the dot is as large.
const HALF: f64 = 0.5;
/// Distances from the middle of the dot, and how many of its radii the last is.
const DISTANCES: u32 = 24;
const FARTHEST: f64 = 3.0;
/// Pieces of the dot's radius, at least, in which it is summed.
const PIECES: f64 = 48.0;

/// Errors of a separable kernel A for a profile R_d, 0 if there is none; means over channels, if of several.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct KernelErrors {
    /// ‖R_d − A‖₂ / ‖R_d‖₂ in the plane: the Frobenius norm of a matrix of fine cells.
    pub frobenius: f64,
    /// ‖R_d − A‖₁ / ‖R_d‖₁ in the plane.
    pub l1: f64,
    /// Largest error of what leaves around a lit disc, which is as large as half of the light goes far, over the brightest.
    pub dot: f64,
    /// Largest error of what leaves at both sides of a shadow's straight edge along an axis, over the brightest.
    pub edge: f64,
}

impl KernelErrors {
    pub(crate) fn mean(channels: impl ExactSizeIterator<Item = Self>) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "channels are three")]
        let share = 1.0 / channels.len() as f64;
        channels.fold(Self::default(), |sum, one| Self {
            frobenius: sum.frobenius + share * one.frobenius,
            l1: sum.l1 + share * one.l1,
            dot: sum.dot + share * one.dot,
            edge: sum.edge + share * one.edge,
        })
    }
}

/// A profile of one channel, and what it is in the cells of a grid.
pub(crate) struct Truth<'a> {
    pub(crate) radial: &'a Radial,
    pub(crate) grid: Grid,
    /// R_d in mm⁻² of the cells of the plane's quarter `[i][j]`.
    pub(crate) plane: Vec<f64>,
}

impl<'a> Truth<'a> {
    pub(crate) fn new(radial: &'a Radial, cells: usize) -> Self {
        let grid = Grid::new(radial.radius_mm(), cells);
        let plane = grid.plane(radial);
        Self { radial, grid, plane }
    }

    /// Errors of a sum of separable terms on this grid.
    pub(crate) fn errors(&self, separable: &Separable) -> KernelErrors {
        let widths = self.grid.widths();
        let n = widths.len();
        let [mut square, mut difference_square, mut absolute, mut difference] = [0.0; 4];
        for (cell, (rd, a)) in self.plane.iter().zip(separable.plane()).enumerate() {
            let area = widths[cell / n] * widths[cell % n];
            square += area * rd * rd;
            difference_square += area * (rd - a) * (rd - a);
            absolute += area * rd.abs();
            difference += area * (rd - a).abs();
        }
        KernelErrors {
            frobenius: (difference_square / square).sqrt(),
            l1: difference / absolute,
            dot: self.dot(separable),
            edge: self.edge(separable),
        }
    }

    /// Light from x < 0 alone: M_e(x) = ½ ‖a_p‖₁ − ∫_0^x a_p, of terms with ‖a‖₁ a in place of a_p.
    fn edge(&self, separable: &Separable) -> f64 {
        let energy = self.radial.energy();
        let integrals = separable.integrals();
        let sums: Vec<Vec<f64>> = (0..separable.terms.len()).map(|t| separable.running(t)).collect();
        let error = |(k, x): (usize, &f64)| {
            let terms = separable.terms.iter().enumerate();
            let a: f64 = terms.map(|(t, (sign, _))| sign * integrals[t] * (0.5 * integrals[t] - sums[t][k])).sum();
            (0.5 * energy - self.radial.along_axis_to(*x) - a).abs()
        };
        self.grid.edges_mm().iter().enumerate().map(error).fold(0.0, f64::max) / energy
    }

    /// A lit disc, seen along the axis and along the diagonal.
    fn dot(&self, separable: &Separable) -> f64 {
        let rho = self.radial.radius_of(HALF);
        let sums: Vec<Vec<f64>> = (0..separable.terms.len()).map(|t| separable.running(t)).collect();
        let mut worst: f64 = 0.0;
        for distance in (0..=DISTANCES).map(|k| FARTHEST * rho * f64::from(k) / f64::from(DISTANCES)) {
            let exact: f64 = self.radial.discs().map(|(r, fall)| fall * lens(r, rho, distance)).sum();
            for [x, y] in [[distance, 0.0], [distance * 0.5_f64.sqrt(); 2]] {
                let terms = separable.terms.iter().enumerate();
                let a: f64 = terms.map(|(t, (sign, _))| sign * disc(separable, t, &sums[t], [x, y], rho)).sum();
                worst = worst.max((a - exact).abs());
            }
        }
        worst / self.radial.discs().map(|(r, fall)| fall * lens(r, rho, 0.0)).sum::<f64>()
    }
}

/// ∫∫ a(x') a(y') over the disc of radius ρ around a point: for each x', ∫ a over its chord.
fn disc(separable: &Separable, t: usize, sums: &[f64], [x, y]: [f64; 2], rho: f64) -> f64 {
    let to = |x: f64| separable.to(t, sums, x);
    let edges = separable.grid.edges_mm();
    let mut sum = 0.0;
    for side in [-1.0, 1.0] {
        for cell in edges.windows(2) {
            let [mut from, mut end] = [side * cell[0], side * cell[1]];
            if side < 0.0 {
                std::mem::swap(&mut from, &mut end);
            }
            (from, end) = (from.max(x - rho), end.min(x + rho));
            if end <= from {
                continue;
            }
            let pieces = ((end - from) / rho * PIECES).ceil();
            let width = (end - from) / pieces;
            let mut piece = 0.0;
            while piece < pieces {
                let start = from + piece * width;
                let off = start + 0.5 * width - x;
                let half = (rho * rho - off * off).max(0.0).sqrt();
                sum += (to(start + width) - to(start)) * (to(y + half) - to(y - half));
                piece += 1.0;
            }
        }
    }
    sum
}

/// Area that discs of radii `a` and `b`, their middles `d` apart, have in common.
fn lens(a: f64, b: f64, d: f64) -> f64 {
    let smaller = a.min(b);
    if d <= (a - b).abs() {
        return PI * smaller * smaller;
    }
    if d >= a + b {
        return 0.0;
    }
    // The chord between them, seen from both middles.
    let segment = |r: f64, other: f64| {
        let cosine = ((d * d + r * r - other * other) / (2.0 * d * r)).clamp(-1.0, 1.0);
        let angle = cosine.acos();
        r * r * (angle - angle.sin() * angle.cos())
    };
    segment(a, b) + segment(b, a)
}
