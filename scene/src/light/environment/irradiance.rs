//! Irradiance from an environment, as nine coefficients of the normal.

use glam::DVec3;

use super::picture::{Picture, single};

/// Coefficients of [`super::Environment::irradiance_coefficients`].
///
/// Exact for a picture whose pixels are each of one radiance.
pub(super) fn project(picture: &Picture) -> [[f32; 3]; 9] {
    use std::f64::consts::{PI, TAU};
    let [width, height] = picture.size.map(f64::from);
    let integral = |of: fn(f64) -> f64, [low, high]: [f64; 2]| of(high) - of(low);

    // ∫ 1, sin φ, cos φ, sin 2φ, cos 2φ dφ over each column, φ = 0 along z.
    let of_phi: [fn(f64) -> f64; 5] =
        [|a| a, |a| -a.cos(), |a| a.sin(), |a| -0.5 * (2.0 * a).cos(), |a| 0.5 * (2.0 * a).sin()];
    let edges = |k: u32, n: f64| [f64::from(k), f64::from(k) + 1.0].map(|edge| edge / n);
    let columns: Vec<[f64; 5]> = (0..picture.size[0])
        .map(|x| edges(x, width).map(|u| TAU * (u - 0.5)))
        .map(|phi| of_phi.map(|of| integral(of, phi)))
        .collect();
    // ∫ 1, cos θ, sin θ, sin θ cos θ, sin² θ, cos² θ times sin θ dθ over each row, θ = 0 along y.
    let of_theta: [fn(f64) -> f64; 6] = [
        |a| -a.cos(),
        |a| 0.5 * a.sin().powi(2),
        |a| 0.5 * (a - a.sin() * a.cos()),
        |a| a.sin().powi(3) / 3.0,
        |a| a.cos().powi(3) / 3.0 - a.cos(),
        |a| -a.cos().powi(3) / 3.0,
    ];

    // ∫ L P dω for each polynomial P of the sum.
    let mut sums = [DVec3::ZERO; 9];
    for (y, row) in (0..).zip(picture.pixels.chunks_exact(columns.len())) {
        let mut around = [DVec3::ZERO; 5];
        for (radiance, column) in row.iter().zip(&columns) {
            let radiance = radiance.as_dvec3();
            for k in 0..5 {
                around[k] += radiance * column[k];
            }
        }
        let [one, sin, cos, sin_2, cos_2] = around;
        let [t_one, t_cos, t_sin, t_sin_cos, t_sin_sq, t_cos_sq] =
            of_theta.map(|of| integral(of, edges(y, height).map(|v| PI * v)));
        sums[0] += one * t_one;
        sums[1] += one * t_cos;
        sums[2] += cos * t_sin;
        sums[3] += sin * t_sin;
        sums[4] += sin * t_sin_cos;
        sums[5] += cos * t_sin_cos;
        // cos² φ = (1 + cos 2φ) / 2, sin φ cos φ = sin 2φ / 2, sin² φ = (1 − cos 2φ) / 2.
        sums[6] += 1.5 * (one + cos_2) * t_sin_sq - one * t_one;
        sums[7] += 0.5 * sin_2 * t_sin_sq;
        sums[8] += 0.5 * (one - cos_2) * t_sin_sq - one * t_cos_sq;
    }

    // A_l K², with A = π, 2π/3, π/4 of the cosine lobe and Y = K P.
    let quadratic = 15.0 / 16.0;
    let factors = [0.25, 0.5, 0.5, 0.5, quadratic, quadratic, quadratic / 12.0, quadratic, quadratic / 4.0];
    std::array::from_fn(|k| (sums[k] * factors[k]).to_array().map(single))
}
