//! Four-wide arithmetic: red, green, blue and a lane that stays zero, so that a pixel's colour is one vector register.

/// Red, green, blue, unused.
pub(crate) type Lanes = [f32; 4];

pub(crate) const ZERO: Lanes = [0.0; 4];

/// Adds s b to a, lane by lane.
#[inline]
pub(crate) fn add_scaled(a: &mut Lanes, s: f32, b: &Lanes) {
    for c in 0..4 {
        a[c] += s * b[c];
    }
}

/// Adds b · d to a, lane by lane.
#[inline]
pub(crate) fn add_product(a: &mut Lanes, b: &Lanes, d: &Lanes) {
    for c in 0..4 {
        a[c] += b[c] * d[c];
    }
}

/// Adds b to a, lane by lane.
#[inline]
pub(crate) fn add(a: &mut Lanes, b: &Lanes) {
    for c in 0..4 {
        a[c] += b[c];
    }
}

/// Σ_n a_n b_n per lane, in double precision.
pub(crate) fn dot(a: &[Lanes], b: &[Lanes]) -> [f64; 4] {
    let mut sum = [0.0; 4];
    for (a, b) in a.iter().zip(b) {
        for c in 0..4 {
            sum[c] += f64::from(a[c]) * f64::from(b[c]);
        }
    }
    sum
}

/// Sum of two sums, lane by lane.
pub(crate) fn sum(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    [0, 1, 2, 3].map(|c| a[c] + b[c])
}

/// Subtracts α A p from a residual, lane by lane: a step of conjugate gradients.
pub(crate) fn subtract_image(residual: &mut [Lanes], alpha: &Lanes, image: &[Lanes]) {
    for (residual, image) in residual.iter_mut().zip(image) {
        for c in 0..4 {
            residual[c] -= alpha[c] * image[c];
        }
    }
}

/// Replaces a direction p by z + β p, the next conjugate one, lane by lane.
pub(crate) fn turn(direction: &mut [Lanes], beta: &Lanes, z: &[Lanes]) {
    for (direction, z) in direction.iter_mut().zip(z) {
        for c in 0..4 {
            direction[c] = z[c] + beta[c] * direction[c];
        }
    }
}

/// Quotient a / b of each lane, rounded to f32; 0 where b is not positive.
pub(crate) fn ratio(a: [f64; 4], b: [f64; 4]) -> Lanes {
    #[allow(clippy::cast_possible_truncation, reason = "step lengths need no more than f32")]
    [0, 1, 2, 3].map(|c| if b[c] > 0.0 { (a[c] / b[c]) as f32 } else { 0.0 })
}
