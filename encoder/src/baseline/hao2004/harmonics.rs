//! Spherical harmonics (section 4.1).

use std::f64::consts::PI;

use nalgebra::{DMatrix, DVector};

use crate::math::matrix::product;
use crate::math::uniform::codes;
use crate::transfer::Scheme;

/// Singular values below which a direction of the least squares is left out, by the largest.
const LEAST_SINGULAR: f64 = 1e-6;

/// q in real spherical harmonics of order n, n² coefficients for each vertex, each in so many even steps between its least and its
/// largest over the mesh.
///
/// Coefficients are those of least squares at the lights; the paper adds up q y over them, which is less close.
pub struct Harmonics {
    /// Functions at the lights `[light × function]`.
    functions: DMatrix<f32>,
    /// Rounded coefficients `[function × vertex]`.
    coefficients: DMatrix<f32>,
    bytes: u64,
}

impl Harmonics {
    /// Harmonics of q `[light × vertex]` at unit directions, with `bytes` for each coefficient, 1 or 2: the paper has 2 here, and 1 for
    /// differences to reference points.
    #[must_use]
    pub fn new(q: &DMatrix<f32>, lights: &[[f32; 3]], order: usize, bytes: u8) -> Self {
        let count = order * order;
        let mut functions = DMatrix::zeros(lights.len(), count);
        for (mut row, light) in functions.row_iter_mut().zip(lights) {
            row.copy_from_slice(&harmonics(order, *light));
        }
        let svd = functions.clone().svd(true, true);
        let least = LEAST_SINGULAR * svd.singular_values.max();
        let solver = svd.pseudo_inverse(least).expect("both sides were asked for");
        let mut coefficients = product(&solver.cast::<f32>(), q);
        let most = if bytes == 1 { u16::from(u8::MAX) } else { u16::MAX };
        for mut row in coefficients.row_iter_mut() {
            let values: Vec<f32> = row.iter().copied().collect();
            let ([offset, step], codes) = codes(values.iter().copied(), most);
            for (value, code) in row.iter_mut().zip(codes) {
                *value = offset + step * f32::from(code);
            }
        }
        // A function has an offset and a step.
        let bytes = u64::from(bytes) * coefficients.len() as u64 + 8 * count as u64;
        Self { functions: functions.cast(), coefficients, bytes }
    }

    /// Bytes of the coefficients and of their steps.
    #[must_use]
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

impl Scheme for Harmonics {
    fn exitance(&self, weights: &[f32]) -> Vec<f32> {
        let of_light = self.functions.tr_mul(&DVector::from_column_slice(weights));
        self.coefficients.tr_mul(&of_light).as_slice().to_vec()
    }
}

/// Real spherical harmonics y_l^m at a unit direction for l below `order`, at l² + l + m; z is the axis from which θ counts.
fn harmonics(order: usize, towards: [f32; 3]) -> Vec<f64> {
    let [x, y, z] = towards.map(f64::from);
    let mut out = vec![0.0; order * order];
    // sinᵐ θ cos mφ and sinᵐ θ sin mφ are the parts of (x + iy)ᵐ; Legendre's functions are without sinᵐ θ, whose start is (2m − 1)!!.
    let (mut cosine, mut sine, mut start) = (1.0, 0.0, 1.0);
    for m in 0..order {
        let [mut before, mut legendre] = [0.0, start];
        for l in m..order {
            let k = ((2 * l + 1) as f64 / (4.0 * PI) * factorial_ratio(l - m, l + m)).sqrt();
            let middle = l * l + l;
            if m == 0 {
                out[middle] = k * legendre;
            } else {
                out[middle + m] = 2.0_f64.sqrt() * k * cosine * legendre;
                out[middle - m] = 2.0_f64.sqrt() * k * sine * legendre;
            }
            // (l + 1 − m) P_{l+1} = (2l + 1) z P_l − (l + m) P_{l−1}.
            let next = ((2 * l + 1) as f64 * z * legendre - (l + m) as f64 * before) / (l + 1 - m) as f64;
            [before, legendre] = [legendre, next];
        }
        (cosine, sine) = (x * cosine - y * sine, x * sine + y * cosine);
        start *= (2 * m + 1) as f64;
    }
    out
}

/// a! / b! for a ≤ b.
fn factorial_ratio(a: usize, b: usize) -> f64 {
    (a + 1..=b).map(|k| 1.0 / k as f64).product()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::transfer::fibonacci;

    #[test]
    fn functions_are_orthonormal() {
        let lights = fibonacci(4_000);
        let mut gram = DMatrix::<f64>::zeros(49, 49);
        for light in &lights {
            let row = DVector::from_vec(harmonics(7, *light));
            gram += &row * row.transpose() * (4.0 * PI / lights.len() as f64);
        }
        let off = gram - DMatrix::identity(49, 49);
        assert!(off.amax() < 2e-3, "{}", off.amax());
        // y_2^1 = √(15 / 4π) x z, y_2^−2 = √(15 / 4π) x y.
        let [x, y, z] = [0.48_f32, 0.6, 0.64];
        let found = harmonics(3, [x, y, z]);
        let factor = (15.0 / (4.0 * PI)).sqrt();
        assert!((found[7] - factor * f64::from(x * z)).abs() < 1e-6, "{}", found[7]);
        assert!((found[4] - factor * f64::from(x * y)).abs() < 1e-6, "{}", found[4]);
    }

    #[test]
    fn functions_of_a_band_come_back_and_more_bands_are_closer() {
        let lights = fibonacci(120);
        let dot = |a: &[f32; 3], b: &[f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        // Powers of cosines to each vertex's own axis: a polynomial of degree 3, and one that ends at the horizon.
        let axes = fibonacci(40);
        let of = |value: &dyn Fn(f32) -> f32| {
            DMatrix::from_fn(lights.len(), axes.len(), |j, v| value(dot(&lights[j], &axes[v])))
        };
        let cubic = of(&|cosine| 0.3 + 0.2 * cosine - 0.4 * cosine * cosine + 0.5 * cosine.powi(3));
        let clamped = of(&|cosine| cosine.max(0.0));
        let error = |q: &DMatrix<f32>, order: usize| {
            let stored = Harmonics::new(q, &lights, order, 2);
            let of_light = |j: usize| {
                let one: Vec<f32> = (0..lights.len()).map(|k| if k == j { 1.0 } else { 0.0 }).collect();
                let found = stored.exitance(&one);
                found.iter().zip(q.row(j).iter()).map(|(a, b)| (a - b).powi(2)).sum::<f32>()
            };
            ((0..lights.len()).map(of_light).sum::<f32>() / q.len() as f32).sqrt()
        };
        assert!(error(&cubic, 4) < 1e-4, "order 4 has degree 3: {}", error(&cubic, 4));
        assert!(error(&cubic, 3) > 0.01, "order 3 has degree 2: {}", error(&cubic, 3));
        // Odd bands of a clamped cosine but the first are empty (Ramamoorthi and Hanrahan 2001): every second order is closer.
        let errors = [1, 2, 3, 5, 7].map(|order| error(&clamped, order));
        assert!(errors.is_sorted_by(|a, b| *a > 1.3 * b), "{errors:?}");
    }
}
