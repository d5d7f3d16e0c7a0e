//! Products of the normal equations with fields of profiles, and the cost of a field.

use super::Normal;
use super::counts::COUNTS;
use crate::bssrdf::field::Field;
use crate::math::lanes::{self, Lanes, ZERO};
use crate::math::parallel;

impl Normal {
    /// Σ_j φ n_ij a aᵀ p_j of one pixel, itself included.
    pub(crate) fn cross(&self, field: &Field, deltas: &[isize], pixel: usize, out: &mut [Lanes]) {
        out.fill(ZERO);
        let window = deltas.len();
        let counts = self.counts.as_ref().map(|counts| &counts[pixel * window..][..window]);
        let mut next = 0;
        for ring in &self.rings {
            let range = next..next + ring.offsets.len();
            next = range.end;
            let start = field.node(pixel, ring.h);
            let (mut below, mut above) = (ZERO, ZERO);
            if let Some(counts) = counts {
                for (delta, count) in deltas[range.clone()].iter().zip(&counts[range]) {
                    let [p, q] = field.pair(start, *delta);
                    let n = &COUNTS[usize::from(*count)];
                    lanes::add_product(&mut below, n, p);
                    lanes::add_product(&mut above, n, q);
                }
            } else {
                for delta in &deltas[range] {
                    let [p, q] = field.pair(start, *delta);
                    lanes::add(&mut below, p);
                    lanes::add(&mut above, q);
                }
                for c in 0..4 {
                    below[c] *= 2.0;
                    above[c] *= 2.0;
                }
            }
            let (w, phi) = (ring.w, ring.phi);
            for c in 0..4 {
                let p = phi * ((1.0 - w) * below[c] + w * above[c]);
                out[ring.h][c] += (1.0 - w) * p;
                out[ring.h + 1][c] += w * p;
            }
        }
    }

    /// out = A_i p_i + Σ_j φ n_ij a aᵀ p_j of one pixel: the normal matrix times a field.
    pub(crate) fn image(&self, field: &Field, deltas: &[isize], pixel: usize, out: &mut [Lanes]) {
        self.cross(field, deltas, pixel, out);
        self.matrix(pixel).all.multiply_add(field.at(pixel), out);
    }

    /// d = b_i − Σ_{j≠i} φ n a aᵀ p_j of one pixel: with all others fixed, its profile p costs pᵀ A p − 2 pᵀ d, A being the
    /// curvature of [`Matrix::curvature`].
    pub(crate) fn pull(&self, field: &Field, deltas: &[isize], pixel: usize) -> Vec<Lanes> {
        let mut d = vec![ZERO; self.geometry.nodes];
        self.cross(field, deltas, pixel, &mut d);
        // The sum has the pixel's own old profile in it; take that out again.
        let mut own = vec![ZERO; self.geometry.nodes];
        self.matrix(pixel).own.multiply_add(field.at(pixel), &mut own);
        for ((d, own), b) in d.iter_mut().zip(&own).zip(self.b(pixel)) {
            for c in 0..4 {
                d[c] = b[c] - (d[c] - own[c]);
            }
        }
        d
    }

    /// Σ_j n_ij f_j of every ring, f a table with one node per ring.
    pub(crate) fn ring_sums(&self, table: &Field, deltas: &[isize], pixel: usize, out: &mut [Lanes]) {
        out.fill(ZERO);
        let window = deltas.len();
        let counts = self.counts.as_ref().map(|counts| &counts[pixel * window..][..window]);
        let mut next = 0;
        for (k, ring) in self.rings.iter().enumerate() {
            let range = next..next + ring.offsets.len();
            next = range.end;
            let start = table.node(pixel, k);
            let sum = &mut out[k];
            if let Some(counts) = counts {
                for (delta, count) in deltas[range.clone()].iter().zip(&counts[range]) {
                    lanes::add_product(sum, &COUNTS[usize::from(*count)], table.value(start, *delta));
                }
            } else {
                for delta in &deltas[range] {
                    lanes::add(sum, table.value(start, *delta));
                }
                for c in 0..4 {
                    sum[c] *= 2.0;
                }
            }
        }
    }

    /// Offsets in ring order as distances in a field's memory.
    pub(crate) fn deltas(&self, field: &Field) -> Vec<isize> {
        self.rings.iter().flat_map(|ring| ring.offsets.iter().map(|offset| field.delta(offset.step))).collect()
    }

    /// ½ Σ_e φ (a·p_i + a·p_j − y_e)².
    pub(crate) fn cost(&self, field: &Field) -> f64 {
        let deltas = self.deltas(field);
        let nodes = self.geometry.nodes;
        let rows: Vec<f64> = parallel::map(self.geometry.pixels(), |pixel| {
            let mut image = vec![ZERO; nodes];
            self.image(field, &deltas, pixel, &mut image);
            let quadratic = lanes::dot(field.at(pixel), &image);
            let linear = lanes::dot(field.at(pixel), self.b(pixel));
            (0..3).map(|c| quadratic[c] - 2.0 * linear[c]).sum()
        });
        0.5 * (rows.iter().sum::<f64>() + self.y2)
    }
}
