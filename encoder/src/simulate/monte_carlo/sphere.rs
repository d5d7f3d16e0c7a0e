//! Light from the centre of a homogeneous sphere that scatters isotropically: how much of it leaves, and at what angles.
//!
//! Lengths are in mean free paths. With φ(r) the flux 4π φ of an isotropic source of one at the centre, a the albedo and
//! ψ = r φ, Peierls' equation reads ψ(r) = e^−r / r + a/2 ∫ ψ(r') (E₁(|r − r'|) − E₁(r + r')) dr' (Case, de Hoffmann and
//! Placzek 1953, *Introduction to the theory of neutron diffusion*). It is solved for χ, ψ less its first term, on nodes of
//! Gauss's rule in panels that are short at the centre and at the surface; nothing of the integrals depends on the albedo.

use std::f64::consts::FRAC_PI_2;

use nalgebra::{DMatrix, DVector};

use crate::math::quadrature::{Gauss, e1};

/// Nodes of χ in a panel.
const NODES: u32 = 6;
/// First panel at the centre, and at the surface; each is so much longer than the one before, by so much at most.
const FIRST: f64 = 0.04;
const GROWTH: f64 = 3.0;
const LONGEST: f64 = 6.0;
/// Angles from 0 to π/2 at which light leaves.
const ANGLES: usize = 256;

/// A sphere, ready to be solved for any albedo.
pub(super) struct Sphere {
    radius: f64,
    /// ½ ∫ basis_j (E₁ − E₁) dr' at node i.
    kernel: DMatrix<f64>,
    /// The same of e^−r / r.
    first: DVector<f64>,
    /// ∫ basis_j r dr.
    collided: DVector<f64>,
    /// Share that leaves in each cell of angles, by a and by χ at the nodes.
    leaving: DMatrix<f64>,
    /// The same, of light that collided once.
    leaving_first: DVector<f64>,
}

/// What leaves a sphere.
pub(super) struct Exits {
    /// Share of the light that leaves, all collisions but that at the centre counted.
    pub(super) share: f64,
    /// Of that: what never collided, which leaves along the normal, and what leaves in each of equal cells of angles from it,
    /// 0 to π/2.
    unscattered: f64,
    cells: Vec<f64>,
}

/// Panels of the radius, and the basis on their nodes.
struct Panels {
    edges: Vec<f64>,
    rule: Gauss,
}

impl Panels {
    fn new(radius: f64) -> Self {
        let (mut from_end, mut length, mut at) = (Vec::new(), FIRST, FIRST);
        while at < 0.5 * radius {
            from_end.push(at);
            length = (GROWTH * length).min(LONGEST);
            at += length;
        }
        let mut edges = vec![0.0];
        edges.extend(&from_end);
        edges.push(0.5 * radius);
        edges.extend(from_end.iter().rev().map(|at| radius - at));
        edges.push(radius);
        Self { edges, rule: Gauss::new(NODES) }
    }

    fn panels(&self) -> impl Iterator<Item = [f64; 2]> {
        self.edges.windows(2).map(|edges| [edges[0], edges[1]])
    }

    fn nodes(&self) -> Vec<(f64, f64)> {
        self.panels().flat_map(|[a, b]| self.rule.over(a, b)).collect()
    }

    /// Adds `weight` times each of a panel's Lagrange polynomials at `x` to what belongs to its nodes.
    fn spread(nodes: &[(f64, f64)], x: f64, weight: f64, mut add: impl FnMut(usize, f64)) {
        for (j, (at, _)) in nodes.iter().enumerate() {
            let others = nodes.iter().enumerate().filter(|(k, _)| *k != j);
            add(j, others.fold(weight, |product, (_, (other, _))| product * (x - other) / (at - other)));
        }
    }
}

impl Sphere {
    pub(super) fn new(radius: f64) -> Self {
        let panels = Panels::new(radius);
        let nodes = panels.nodes();
        let (count, per_panel) = (nodes.len(), NODES as usize);
        let fine = Gauss::new(8);
        let mut kernel = DMatrix::zeros(count, count);
        let mut first = DVector::zeros(count);
        for (i, (r, _)) in nodes.iter().enumerate() {
            for (panel, [a, b]) in panels.panels().enumerate() {
                let from = panel * per_panel;
                fine.towards(*r, a, b, &mut |x, w| {
                    let value = 0.5 * w * (e1((r - x).abs()) - e1(r + x));
                    first[i] += value * (-x).exp() / x;
                    Panels::spread(&nodes[from..][..per_panel], x, value, |j, part| kernel[(i, from + j)] += part);
                });
            }
        }
        let collided = DVector::from_iterator(count, nodes.iter().map(|(r, w)| r * w));
        let (leaving, leaving_first) = leaving(radius, &panels, &nodes);
        Self { radius, kernel, first, collided, leaving, leaving_first }
    }

    /// What leaves where the albedo is `albedo`, 0 to 1.
    pub(super) fn solve(&self, albedo: f64) -> Exits {
        let (mut cells, absorbed) = self.light(albedo);
        let unscattered = (-self.radius).exp();
        let leaves = unscattered + cells.sum();
        // Both make one, but for errors of the nodes: so nothing is lost where nothing is absorbed.
        let share = leaves / (leaves + absorbed);
        cells /= leaves;
        Exits { share, unscattered: unscattered / leaves, cells: cells.as_slice().to_vec() }
    }

    /// Scattered light that leaves, by angles, and light that is absorbed.
    fn light(&self, albedo: f64) -> (DVector<f64>, f64) {
        let system = DMatrix::identity(self.kernel.nrows(), self.kernel.ncols()) - albedo * &self.kernel;
        let flux = system.lu().solve(&(albedo * &self.first)).expect("scattering within a sphere loses light");
        let collided = 1.0 - (-self.radius).exp() + self.collided.dot(&flux);
        (albedo * (&self.leaving_first + &self.leaving * &flux), (1.0 - albedo) * collided)
    }
}

/// Share of the light that leaves per cell of angles, by a: 2π μ 4π R² times the intensity, which is ∫ a φ / 4π e^−s ds along a
/// chord of the sphere. With b = R sin α its distance from the centre, T = R cos α half its length and t the place on it,
/// φ = ψ / r and dt = r dy for t = b sinh y: b e^−T ∫ ψ cosh t dy.
fn leaving(radius: f64, panels: &Panels, nodes: &[(f64, f64)]) -> (DMatrix<f64>, DVector<f64>) {
    let per_panel = NODES as usize;
    let fine = Gauss::new(8);
    let mut by_flux = DMatrix::zeros(ANGLES, nodes.len());
    let mut first = DVector::zeros(ANGLES);
    #[allow(clippy::cast_precision_loss, reason = "cells are few")]
    let width = FRAC_PI_2 / ANGLES as f64;
    for cell in 0..ANGLES {
        #[allow(clippy::cast_precision_loss, reason = "cells are few")]
        let alpha = (cell as f64 + 0.5) * width;
        let (b, half) = (radius * alpha.sin(), radius * alpha.cos());
        // db = R cos α dα.
        let scale = half * width * b;
        let y = |r: f64| ((r * r - b * b).max(0.0).sqrt() / b).asinh();
        for (panel, [from, to]) in panels.panels().enumerate().filter(|(_, [_, to])| *to > b) {
            let at = panel * per_panel;
            for (y, w) in fine.over(y(from), y(to)) {
                let (t, r) = (b * y.sinh(), b * y.cosh());
                let weight = scale * w * 0.5 * ((t - half).exp() + (-t - half).exp());
                first[cell] += weight * (-r).exp() / r;
                Panels::spread(&nodes[at..][..per_panel], r, weight, |j, part| by_flux[(cell, at + j)] += part);
            }
        }
    }
    (by_flux, first)
}

impl Exits {
    /// Mean cosines to the normal of as many equal parts of the light that leaves as `bins` has, those along the normal first.
    pub(super) fn cosines(&self, bins: &mut [f32]) {
        #[allow(clippy::cast_precision_loss, reason = "bins and cells are few")]
        let (part, width) = (1.0 / bins.len() as f64, FRAC_PI_2 / self.cells.len() as f64);
        let mut unscattered = self.unscattered;
        // The cell that light is taken from, and where in it, as a share.
        let (mut cell, mut taken) = (0, 0.0);
        for bin in bins {
            let straight = unscattered.min(part);
            unscattered -= straight;
            let (mut wanted, mut sum) = (part - straight, straight);
            while wanted > 0.0 && cell < self.cells.len() {
                let of_cell = self.cells[cell];
                let share = (wanted / of_cell).min(1.0 - taken);
                #[allow(clippy::cast_precision_loss, reason = "cells are few")]
                let [a, b] = [taken, taken + share].map(|x| (cell as f64 + x) * width);
                // Mean of cos α over a .. b.
                sum += share * of_cell * (0.5 * (a + b)).cos() * sinc(0.5 * (b - a));
                wanted -= share * of_cell;
                taken += share;
                if taken >= 1.0 - 1e-12 {
                    (cell, taken) = (cell + 1, 0.0);
                }
                if share == 0.0 {
                    break;
                }
            }
            #[allow(clippy::cast_possible_truncation, reason = "tables are of single precision")]
            let mean = (sum / (part - wanted)).clamp(0.0, 1.0) as f32;
            *bin = mean;
        }
    }
}

fn sinc(x: f64) -> f64 {
    if x < 1e-6 { 1.0 } else { x.sin() / x }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_light_leaves_or_is_absorbed() {
        for radius in [1.0, 3.5, 56.0] {
            let sphere = Sphere::new(radius);
            for albedo in [0.0, 0.5, 0.9, 0.999, 1.0] {
                let (cells, absorbed) = sphere.light(albedo);
                let whole = (-radius).exp() + cells.sum() + absorbed;
                assert!((whole - 1.0).abs() < 2e-5, "radius {radius}, albedo {albedo}: {whole}");
                let share = sphere.solve(albedo).share;
                assert!(share >= (-radius).exp() && share <= 1.0, "radius {radius}, albedo {albedo}: {share} leaves");
            }
        }
    }

    #[test]
    fn a_large_sphere_is_a_half_space_from_inside() {
        // Light that comes from deep in a half-space that absorbs nothing leaves with a mean cosine of Hopf's constant, 0.710446; of
        // a sphere that is off by about a sixth of 1/R.
        let mut cosines = [0.0; 256];
        Sphere::new(56.0).solve(1.0).cosines(&mut cosines);
        let mean = cosines.iter().copied().map(f64::from).sum::<f64>() / 256.0;
        assert!((mean - 0.710_446 - 0.161 / 56.0).abs() < 2e-4, "{mean}");
        assert!(cosines.is_sorted_by(|a, b| a >= b), "angles grow");
    }
}
