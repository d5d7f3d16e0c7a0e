//! Arc tangent without libm: three of them are in every evaluation.

use core::f32::consts::{FRAC_PI_2, PI};

/// atan(z) / z in z², z in 0 to 1: a minimax fit of our own, off by 2.5e-7 rad before rounding.
const ATAN: [f32; 7] =
    [0.999_996_1, -0.333_173_66, 0.198_077_92, -0.132_332_61, 0.079_622_28, -0.033_603_087, 0.006_811_438];

/// Angle of (x, y) from the x axis in rad, −π to π, within 1e-6; 0 of (0, 0).
#[inline(always)]
pub(crate) fn atan2(y: f32, x: f32) -> f32 {
    let (ax, ay) = (x.abs(), y.abs());
    let (small, large) = if ax < ay { (ax, ay) } else { (ay, ax) };
    let z = small / if large > f32::MIN_POSITIVE { large } else { f32::MIN_POSITIVE };
    // Halves of the series do not wait for each other.
    let [c0, c1, c2, c3, c4, c5, c6] = ATAN;
    let u = z * z;
    let (u2, low, high) = (u * u, c0 + u * c1, c2 + u * c3);
    let first = z * ((low + u2 * high) + (u2 * u2) * ((c4 + u * c5) + u2 * c6));
    let quadrant = if ax < ay { FRAC_PI_2 - first } else { first };
    let half = if x < 0.0 { PI - quadrant } else { quadrant };
    half.copysign(y)
}

/// Sine and cosine of an angle of −π/2 to π/2 rad, within 2e-7; the cosine is not negative.
#[inline]
pub(crate) fn sin_cos(angle: f32) -> [f32; 2] {
    // Taylor series of half of it, which is less than π/4.
    let x = 0.5 * angle;
    let u = x * x;
    let sin = x * (1.0 - u * (1.0 / 6.0 - u * (1.0 / 120.0 - u * (1.0 / 5_040.0 - u * (1.0 / 362_880.0)))));
    let cos = 1.0 - u * (0.5 - u * (1.0 / 24.0 - u * (1.0 / 720.0 - u * (1.0 / 40_320.0))));
    [2.0 * sin * cos, (1.0 - 2.0 * sin * sin).max(0.0)]
}

/// Square root, of 0 what is not positive.
pub(crate) fn sqrt(x: f32) -> f32 {
    libm::sqrtf(x.max(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_are_those_of_libm() {
        let places = (0..2_000_u16).map(|k| f32::from(k) * 0.0031);
        for angle in places {
            for length in [1e-6_f32, 1.0, 3e5] {
                let (y, x) = (length * libm::sinf(angle), length * libm::cosf(angle));
                let error = atan2(y, x) - libm::atan2f(y, x);
                assert!(error.abs() < 1e-6, "{y} {x}: {error}");
            }
        }
        assert_eq!(atan2(0.0, 0.0).to_bits(), 0.0_f32.to_bits(), "no direction");
    }

    #[test]
    fn sines_and_cosines_are_those_of_libm() {
        for angle in (-1_000..=1_000_i16).map(|k| f32::from(k) * (FRAC_PI_2 / 1_000.0)) {
            let [sin, cos] = sin_cos(angle);
            let (error, of_cos) = (sin - libm::sinf(angle), cos - libm::cosf(angle));
            assert!(error.abs() < 2e-7 && of_cos.abs() < 2e-7 && cos >= 0.0, "{angle}: {error:e}, {of_cos:e}");
        }
    }
}
