//! Sides of the box that triangles belong to.
//!
//! The labels l of triangles t minimise Σ_t A_t (1 − n_t · l_t) + λ Σ_e |e| s_e over the edges e between triangles of different
//! labels, s_e less in concave folds, approximately: by single triangles, then by whole charts.

use std::collections::BTreeMap;

use glam::Vec3;

use super::surface::{NONE, Surface};

/// Directions of the sides: x, y, z, −x, −y, −z.
const SIDES: [Vec3; 6] = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
/// Most passes of each kind: they end when nothing changes.
const PASSES: usize = 24;
/// Cost of a seam in a concave fold, where it is little seen, by that of others.
const CONCAVE: f32 = 0.4;
/// Cost of a seam between opposite sides, which are not blended.
const OPPOSITE: f32 = 3.0;

/// Label of each triangle, 0 to 5 for the sides that face x, y, z, −x, −y, −z. `width_mm`: λ, and how far normals are smoothed.
pub(super) fn labels(surface: &Surface, width_mm: f32) -> Vec<u8> {
    let normals = smooth(surface, width_mm);
    let mut labels: Vec<u8> = normals.iter().map(|normal| best(|label| -normal.dot(SIDES[label as usize]))).collect();
    let energy = Energy { surface, normals, lambda_mm: width_mm };
    // Charts that vanish let seams move on.
    for _ in 0..PASSES {
        energy.move_triangles(&mut labels);
        if !energy.move_charts(&mut labels) {
            break;
        }
    }
    labels
}

/// Normals of triangles, averaged over the neighbours until they reach about `width_mm` far.
fn smooth(surface: &Surface, width_mm: f32) -> Vec<Vec3> {
    let area: f32 = surface.areas.iter().sum();
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    let step_mm2 = area / surface.areas.len() as f32;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let passes = (width_mm * width_mm / step_mm2.max(1e-12)).clamp(0.0, 64.0) as usize;
    let mut normals = surface.normals.clone();
    for _ in 0..passes {
        let mean = |(triangle, around): (usize, &[u32; 3])| {
            let beyond = around.iter().filter(|&&other| other != NONE).map(|&other| other as usize);
            let weighted = |triangle: usize| surface.areas[triangle] * normals[triangle];
            (weighted(triangle) + beyond.map(weighted).sum::<Vec3>()).normalize_or_zero()
        };
        normals = surface.neighbours.iter().enumerate().map(mean).collect();
    }
    normals
}

/// The label of least cost, the first of several.
fn best(cost: impl Fn(u8) -> f32) -> u8 {
    (1..6).fold((0, cost(0)), |least, label| if cost(label) < least.1 { (label, cost(label)) } else { least }).0
}

struct Energy<'a> {
    surface: &'a Surface,
    normals: Vec<Vec3>,
    lambda_mm: f32,
}

impl Energy<'_> {
    /// Cost of a triangle's area on a side, in mm².
    fn slant(&self, triangle: usize, label: u8) -> f32 {
        self.surface.areas[triangle] * (1.0 - self.normals[triangle].dot(SIDES[label as usize]))
    }

    /// λ |e| s_e of edge `k` between two triangles, in mm², for labels that differ.
    fn seam(&self, triangle: usize, k: usize) -> f32 {
        let other = self.surface.neighbours[triangle][k] as usize;
        let towards = self.surface.middles[other] - self.surface.middles[triangle];
        let is_concave = self.surface.normals[triangle].dot(towards) > 0.0;
        self.lambda_mm * self.surface.edge_mm(triangle, k) * if is_concave { CONCAVE } else { 1.0 }
    }

    /// Moves single triangles to better sides.
    fn move_triangles(&self, labels: &mut [u8]) {
        for _ in 0..PASSES {
            let mut changed = false;
            for triangle in 0..labels.len() {
                let around = self.surface.neighbours[triangle];
                let beyond = around.map(|other| labels.get(other as usize).copied());
                let label = labels[triangle];
                if beyond.iter().flatten().all(|other| *other == label) {
                    continue;
                }
                let cost = |label: u8| {
                    // Borders are no seams.
                    let seams = beyond.iter().enumerate().filter_map(|(k, other)| Some((k, (*other)?)));
                    let seams = seams.map(|(k, other)| self.seam(triangle, k) * apart(other, label));
                    self.slant(triangle, label) + seams.sum::<f32>()
                };
                let found = best(cost);
                // Triangles that go back and forth by rounding would never end.
                if found != label && cost(found) < cost(label) * (1.0 - 1e-5) {
                    labels[triangle] = found;
                    changed = true;
                }
            }
            if !changed {
                return;
            }
        }
    }

    /// Moves whole charts to the side of a neighbour, smaller ones first; returns whether any was moved.
    fn move_charts(&self, labels: &mut [u8]) -> bool {
        let (chart_of, mut charts) = self.charts(labels);
        for (triangle, around) in self.surface.neighbours.iter().enumerate() {
            for (k, &other) in around.iter().enumerate().filter(|(_, other)| **other != NONE) {
                let (chart, beyond) = (chart_of[triangle], chart_of[other as usize]);
                if chart != beyond {
                    *charts[chart as usize].seams.entry(beyond).or_default() += self.seam(triangle, k);
                }
            }
        }
        let mut order: Vec<usize> = (0..charts.len()).collect();
        order.sort_by(|&a, &b| charts[a].area_mm2.total_cmp(&charts[b].area_mm2));
        let mut changed = false;
        for chart in order {
            let Chart { label, slants, seams, .. } = &charts[chart];
            let cost = |label: u8| {
                let seams = seams.iter().map(|(&beyond, cost)| cost * apart(charts[beyond as usize].label, label));
                slants[label as usize] + seams.sum::<f32>()
            };
            let found = best(cost);
            if found != *label && cost(found) < cost(*label) * (1.0 - 1e-5) {
                charts[chart].label = found;
                changed = true;
            }
        }
        for (label, &chart) in labels.iter_mut().zip(&chart_of) {
            *label = charts[chart as usize].label;
        }
        changed
    }

    /// Number of the chart of every triangle, and the charts without their seams.
    fn charts(&self, labels: &[u8]) -> (Vec<u32>, Vec<Chart>) {
        let mut chart_of = vec![NONE; labels.len()];
        let mut charts: Vec<Chart> = Vec::new();
        for first in 0..labels.len() {
            if chart_of[first] != NONE {
                continue;
            }
            let number = u32::try_from(charts.len()).unwrap_or(NONE);
            let mut chart = Chart { label: labels[first], area_mm2: 0.0, slants: [0.0; 6], seams: BTreeMap::new() };
            let mut open = vec![first];
            chart_of[first] = number;
            while let Some(triangle) = open.pop() {
                chart.area_mm2 += self.surface.areas[triangle];
                for (sum, label) in chart.slants.iter_mut().zip(0..) {
                    *sum += self.slant(triangle, label);
                }
                for &other in self.surface.neighbours[triangle].iter().filter(|&&other| other != NONE) {
                    let other = other as usize;
                    if chart_of[other] == NONE && labels[other] == chart.label {
                        chart_of[other] = number;
                        open.push(other);
                    }
                }
            }
            charts.push(chart);
        }
        (chart_of, charts)
    }
}

/// Connected triangles of one label.
struct Chart {
    label: u8,
    area_mm2: f32,
    /// Cost of its area on each side, in mm².
    slants: [f32; 6],
    /// Cost of the seam with each chart beside it.
    seams: BTreeMap<u32, f32>,
}

/// Factor on the cost of a seam between two labels.
fn apart(a: u8, b: u8) -> f32 {
    if a == b {
        0.0
    } else if a % 3 == b % 3 {
        OPPOSITE
    } else {
        1.0
    }
}
