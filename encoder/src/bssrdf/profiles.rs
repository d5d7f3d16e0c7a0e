//! Per-pixel local scattering profiles (Song et al. 2009; Yatagawa et al. 2020, eq. 1-3): where the direct method starts.

use crate::bssrdf::field::Field;
use crate::bssrdf::normal::regulariser::regulariser;
use crate::bssrdf::normal::{Matrix, Normal};
use crate::math::banded::Cholesky;
use crate::math::lanes::{self, Lanes, ZERO};
use crate::math::parallel;
use crate::progress::Progress;

/// Largest residual of the solution, relative to the right-hand side.
const TOLERANCE: f64 = 1e-4;
/// Iterations of conjugate gradients, at most.
const MAX_ITERATIONS: u64 = 200;

/// Log-scale profile of every pixel, relative to the mean profile: conjugate gradients on the normal equations,
/// preconditioned with each pixel's own matrix.
pub(crate) fn fit(normal: &Normal, progress: &dyn Progress) -> Field {
    let nodes = normal.geometry.nodes;
    let len = normal.geometry.pixels() * nodes;
    let mut x = Field::new(normal.geometry);
    let mut direction = Field::new(normal.geometry);
    let deltas = normal.deltas(&direction);
    let regulariser = regulariser(nodes);
    let own_block = |matrix: &Matrix| {
        let mut block = matrix.curvature();
        block.add_scaled(1.0, &regulariser);
        block.cholesky()
    };
    let preconditioners: Vec<Cholesky> = parallel::map(normal.matrices.len(), |k| own_block(&normal.matrices[k]));
    let precondition = |residual: &[Lanes]| {
        let mut out = residual.to_vec();
        parallel::for_chunks(&mut out, nodes, |pixel, profile| {
            preconditioners[normal.matrix_of[pixel] as usize].solve(profile);
        });
        out
    };

    let mut residual: Vec<Lanes> = (0..normal.geometry.pixels()).flat_map(|pixel| normal.b(pixel)).copied().collect();
    let mut z = precondition(&residual);
    let mut rho = lanes::dot(&residual, &z);
    let limit = rho.map(|rho| rho * TOLERANCE * TOLERANCE);
    let mut p = z.clone();
    let mut image = vec![ZERO; len];

    progress.begin("fitting per-pixel profiles", MAX_ITERATIONS);
    for iteration in 0..MAX_ITERATIONS {
        if (0..3).all(|c| rho[c] <= limit[c]) {
            progress.advance(MAX_ITERATIONS - iteration);
            break;
        }
        for (pixel, profile) in p.chunks(nodes).enumerate() {
            direction.set(pixel, profile);
        }
        direction.fill_border();
        parallel::for_chunks(&mut image, nodes, |pixel, image| {
            normal.cross(&direction, &deltas, pixel, image);
            normal.matrix(pixel).all.multiply_add(direction.at(pixel), image);
            regulariser.multiply_add(direction.at(pixel), image);
        });
        let alpha = lanes::ratio(rho, lanes::dot(&p, &image));
        for (pixel, step) in p.chunks(nodes).enumerate() {
            let mut profile = x.at(pixel).to_vec();
            for (profile, step) in profile.iter_mut().zip(step) {
                lanes::add_product(profile, &alpha, step);
            }
            x.set(pixel, &profile);
        }
        lanes::subtract_image(&mut residual, &alpha, &image);
        z = precondition(&residual);
        let next = lanes::dot(&residual, &z);
        let beta = lanes::ratio(next, rho);
        lanes::turn(&mut p, &beta, &z);
        rho = next;
        progress.advance(1);
    }
    x.fill_border();
    x
}
