//! Weights by which values at scattered directions give values in between.

use crate::container::bytes::F32Le;

/// How much of a constant and of a linear function covariances have, beside what is curved. Constants come back exactly.
const CONSTANT: f32 = 1.0;
/// Without at least 0.87 of it the covariance has a negative eigenvalue.
const LINEAR: f32 = 2.0;
/// Pivot below which two directions are the same.
const LEAST_PIVOT: f32 = 1e-6;

/// Interpolation between the lights of a file by radial basis functions r² ln r of the distance r between directions, with a
/// constant: Σ_j w_j(ω) q_j goes through every q_j and is smooth in between (Duchon 1977, thin plate splines).
///
/// Solved as kriging with a covariance of 1 + 2 cos θ + u ln u, u = 1 − cos θ = r²/2, which is positive definite on the sphere.
#[derive(Clone, Copy, Debug)]
pub struct LightWeights<'b> {
    lights: F32Le<'b>,
    /// Cholesky's factor of the covariances between lights, rows of the lower triangle.
    factor: &'b [f32],
    /// What solves for weights that are all 1.
    ones: &'b [f32],
    ones_sum: f32,
}

impl<'b> LightWeights<'b> {
    /// Numbers that [`Self::new`] takes room for: n (n + 1) / 2 + n for n lights, 20,300 for 200.
    #[must_use]
    pub fn buffer_len(lights: usize) -> usize {
        row_start(lights).wrapping_add(lights)
    }

    /// Prepares weights for lights, `[light][xyz]`, in O(n³): 2 ms for 200. `None` where `buffer` is shorter than
    /// [`Self::buffer_len`], there are no lights, or two of them are one.
    pub fn new(lights: F32Le<'b>, buffer: &'b mut [f32]) -> Option<Self> {
        let count = lights.len() / 3;
        let (factor, ones) = buffer.get_mut(..Self::buffer_len(count))?.split_at_mut_checked(row_start(count))?;
        for number in 0..count {
            let (above, rest) = factor.split_at_mut_checked(row_start(number))?;
            let row = rest.get_mut(..number.wrapping_add(1))?;
            covariances(lights, light(lights, number), row);
            for column in 0..number {
                let other = above.get(row_start(column)..)?.get(..column.wrapping_add(1))?;
                let (pivot, other) = other.split_last()?;
                let (before, rest) = row.split_at_mut_checked(column)?;
                let value = rest.first_mut()?;
                *value = (*value - dot(before, other)) / pivot;
            }
            let (pivot, before) = row.split_last_mut()?;
            let square = *pivot - dot(before, before);
            if square.is_nan() || square <= LEAST_PIVOT {
                return None;
            }
            *pivot = libm::sqrtf(square);
        }
        ones.fill(1.0);
        solve(factor, ones)?;
        Self::prepared(lights, buffer)
    }

    /// Weights for the lights of a buffer that [`Self::new`] has filled, in no time. `None` where it is shorter than
    /// [`Self::buffer_len`], or filled with something else that adds up to nothing.
    #[must_use]
    pub fn prepared(lights: F32Le<'b>, buffer: &'b [f32]) -> Option<Self> {
        let count = lights.len() / 3;
        let (factor, ones) = buffer.get(..Self::buffer_len(count))?.split_at_checked(row_start(count))?;
        let ones_sum: f32 = ones.iter().sum();
        (ones_sum > 0.0).then_some(Self { lights, factor, ones, ones_sum })
    }

    /// Weights of the lights for light from the unit direction `towards`; they add up to 1, and some are negative. What is longer or
    /// shorter than the number of lights is left as it is.
    pub fn at(&self, towards: [f32; 3], weights: &mut [f32]) {
        if weights.len() != self.ones.len() {
            return;
        }
        covariances(self.lights, towards, weights);
        let missing = if solve(self.factor, weights).is_some() { 1.0 - weights.iter().sum::<f32>() } else { 0.0 };
        for (weight, one) in weights.iter_mut().zip(self.ones) {
            *weight += missing / self.ones_sum * one;
        }
    }
}

/// First number of a row of a lower triangle.
fn row_start(row: usize) -> usize {
    row.wrapping_mul(row.wrapping_add(1)) >> 1
}

fn light(lights: F32Le<'_>, number: usize) -> [f32; 3] {
    lights.rgb_at(number.wrapping_mul(3))
}

/// Covariances between a direction and the first lights, as many as there is room for.
fn covariances(lights: F32Le<'_>, towards: [f32; 3], out: &mut [f32]) {
    for (number, out) in out.iter_mut().enumerate() {
        let cosine = dot(&light(lights, number), &towards).clamp(-1.0, 1.0);
        let u = 1.0 - cosine;
        let curved = if u > 0.0 { u * libm::logf(u) } else { 0.0 };
        *out = CONSTANT + LINEAR * cosine + curved;
    }
}

/// Solves L Lᵀ x = y in place, L in rows of the lower triangle.
fn solve(factor: &[f32], x: &mut [f32]) -> Option<()> {
    for row in 0..x.len() {
        let (before, rest) = x.split_at_mut_checked(row)?;
        let (pivot, left) = factor.get(row_start(row)..)?.get(..row.wrapping_add(1))?.split_last()?;
        let value = rest.first_mut()?;
        *value = (*value - dot(left, before)) / pivot;
    }
    for row in (0..x.len()).rev() {
        let (before, rest) = x.split_at_mut_checked(row)?;
        let (pivot, left) = factor.get(row_start(row)..)?.get(..row.wrapping_add(1))?.split_last()?;
        let value = rest.first_mut()?;
        *value /= pivot;
        for (before, left) in before.iter_mut().zip(left) {
            *before -= left * *value;
        }
    }
    Some(())
}

fn dot(a: &[f32], b: &[f32]) -> f32 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
