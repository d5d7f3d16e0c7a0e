//! Step P: the base profiles, indices and ratios fixed.

use rayon::prelude::*;

use crate::math::banded::{Banded, Factored};
use crate::bssrdf::field::Field;
use crate::math::lanes::{self, Lanes, ZERO};
use crate::bssrdf::profiles::{RIDGE, SMOOTHNESS};
use crate::bssrdf::normal::{BLOCK_ROWS, BLOCKS_AT_ONCE, Normal};
use super::Model;

/// Steps of conjugate gradients in one round; the next round goes on from there.
const ITERATIONS: usize = 6;

/// Lowers the cost, in the profiles of all bases together, by conjugate gradients from where they are.
///
/// With p = U X, U the ratios, the normal matrix is Uᵀ (A + C) U + λ_reg R: products go through the pixels, and the
/// matrix itself is never formed.
pub(crate) fn solve(normal: &Normal, model: &mut Model, field: &mut Field) {
    let nodes = model.nodes;
    let deltas = normal.deltas(field);
    let preconditioners = preconditioners(normal, model);
    let precondition = |residual: &[Lanes]| {
        let mut out = residual.to_vec();
        out.par_chunks_mut(nodes).zip(&preconditioners).for_each(|(base, matrix)| matrix.solve(base));
        out
    };

    model.write_to(field);
    let mut residual = gather(normal, model, |pixel, out| {
        let mut image = vec![ZERO; nodes];
        image_of(normal, field, &deltas, pixel, &mut image);
        for ((out, image), b) in out.iter_mut().zip(&image).zip(normal.b(pixel)) {
            for c in 0..4 {
                out[c] = b[c] - image[c];
            }
        }
    });
    for (residual, image) in residual.iter_mut().zip(regularised(&model.bases, nodes)) {
        for c in 0..4 {
            residual[c] -= image[c];
        }
    }
    let mut z = precondition(&residual);
    let mut rho = lanes::dot(&residual, &z);
    // Directions live in a model of their own, which has the same ratios.
    let mut direction = Model { bases: z.clone(), mixtures: model.mixtures.clone(), palette: None, ..*model };
    for _ in 0..ITERATIONS {
        direction.write_to(field);
        let mut image = gather(normal, model, |pixel, out| image_of(normal, field, &deltas, pixel, out));
        for (image, smooth) in image.iter_mut().zip(regularised(&direction.bases, nodes)) {
            lanes::add(image, &smooth);
        }
        let alpha = lanes::ratio(rho, lanes::dot(&direction.bases, &image));
        for (base, step) in model.bases.iter_mut().zip(&direction.bases) {
            lanes::add_product(base, &alpha, step);
        }
        lanes::subtract_image(&mut residual, &alpha, &image);
        z = precondition(&residual);
        let next = lanes::dot(&residual, &z);
        let beta = lanes::ratio(next, rho);
        lanes::turn(&mut direction.bases, &beta, &z);
        rho = next;
    }
    model.write_to(field);
}

/// out = A_i p_i + Σ_j φ n a aᵀ p_j.
pub(crate) fn image_of(normal: &Normal, field: &Field, deltas: &[isize], pixel: usize, out: &mut [Lanes]) {
    normal.cross(field, deltas, pixel, out);
    normal.matrix(pixel).all.multiply_add(field.at(pixel), out);
}

/// Uᵀ v, with v of each pixel computed on the way. Sums are made by blocks of rows and then in order.
pub(crate) fn gather(normal: &Normal, model: &Model, v: impl Fn(usize, &mut [Lanes]) + Sync) -> Vec<Lanes> {
    let nodes = model.nodes;
    let [width, height] = normal.geometry.size;
    let block = |&first: &usize| {
        let mut sums = vec![ZERO; model.bases.len()];
        let mut image = vec![ZERO; nodes];
        for pixel in first * width..(first + BLOCK_ROWS).min(height) * width {
            v(pixel, &mut image);
            for (base, t) in model.parts(pixel) {
                for (sum, image) in sums[base * nodes..].iter_mut().zip(&image) {
                    lanes::add_scaled(sum, t, image);
                }
            }
        }
        sums
    };
    let firsts: Vec<usize> = (0..height).step_by(BLOCK_ROWS).collect();
    let mut total = vec![ZERO; model.bases.len()];
    for firsts in firsts.chunks(BLOCKS_AT_ONCE) {
        let blocks: Vec<Vec<Lanes>> = firsts.par_iter().map(block).collect();
        for sums in &blocks {
            for (total, sum) in total.iter_mut().zip(sums) {
                lanes::add(total, sum);
            }
        }
    }
    total
}

/// λ_reg R X.
fn regularised(bases: &[Lanes], nodes: usize) -> Vec<Lanes> {
    let regulariser = regulariser(nodes);
    let mut out = vec![ZERO; bases.len()];
    for (base, out) in bases.chunks(nodes).zip(out.chunks_mut(nodes)) {
        regulariser.multiply_add(base, out);
    }
    out
}

fn regulariser(nodes: usize) -> Banded {
    let mut regulariser = Banded::new(nodes);
    regulariser.add_smoothness(SMOOTHNESS);
    regulariser.add_ridge(RIDGE);
    regulariser
}

/// Every base's own block of the matrix, pairs of pixels left out: Σ_i u_ib² A_i + λ_reg R.
fn preconditioners(normal: &Normal, model: &Model) -> Vec<Factored> {
    let mut blocks = vec![regulariser(model.nodes); model.count()];
    for pixel in 0..model.mixtures.len() {
        for (base, t) in model.parts(pixel) {
            blocks[base].add_scaled(t * t, &normal.matrix(pixel).all);
        }
    }
    blocks.into_iter().map(Banded::factor).collect()
}
