//! Step P: the base profiles, indices and ratios fixed.

use crate::bssrdf::field::Field;
use crate::bssrdf::model::Model;
use crate::bssrdf::normal::Normal;
use crate::bssrdf::normal::regulariser::regulariser;
use crate::math::banded::{Banded, Cholesky};
use crate::math::lanes::{self, Lanes, ZERO};
use crate::math::parallel;

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
        parallel::for_chunks(&mut out, nodes, |base, profile| preconditioners[base].solve(profile));
        out
    };

    model.write_to(field);
    let mut residual = model.gather(normal, |pixel, out| {
        let mut image = vec![ZERO; nodes];
        normal.image(field, &deltas, pixel, &mut image);
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
        let mut image = model.gather(normal, |pixel, out| normal.image(field, &deltas, pixel, out));
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

/// Product λ_reg R X with all base profiles X.
fn regularised(bases: &[Lanes], nodes: usize) -> Vec<Lanes> {
    let regulariser = regulariser(nodes);
    let mut out = vec![ZERO; bases.len()];
    for (base, out) in bases.chunks(nodes).zip(out.chunks_mut(nodes)) {
        regulariser.multiply_add(base, out);
    }
    out
}

/// Every base's own block of the matrix, pairs of pixels left out: Σ_i u_ib² A_i + λ_reg R.
fn preconditioners(normal: &Normal, model: &Model) -> Vec<Cholesky> {
    let mut blocks = vec![regulariser(model.nodes); model.count()];
    for pixel in 0..model.mixtures.len() {
        for (base, t) in model.parts(pixel) {
            blocks[base].add_scaled(t * t, &normal.matrix(pixel).all);
        }
    }
    blocks.into_iter().map(Banded::cholesky).collect()
}
