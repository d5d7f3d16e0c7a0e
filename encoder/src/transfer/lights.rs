//! Directions of light for which scattering is precomputed.

use std::f64::consts::{PI, TAU};

use super::rd_table::single;

/// `count` unit directions towards light, even over the sphere: a spiral whose turns are a golden angle apart (González 2010,
/// *Measurement of areas on a sphere using Fibonacci and latitude-longitude lattices*).
#[must_use]
pub fn fibonacci(count: usize) -> Vec<[f32; 3]> {
    let golden = PI * (3.0 - 5.0_f64.sqrt());
    let direction = |k: usize| {
        // Equal areas: y is even between −1 and 1.
        let y = 1.0 - (2.0 * k as f64 + 1.0) / count as f64;
        let (radius, turn) = ((1.0 - y * y).max(0.0).sqrt(), (k as f64 * golden) % TAU);
        [libm::cos(turn) * radius, y, libm::sin(turn) * radius].map(single)
    };
    (0..count).map(direction).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_are_even() {
        for count in [1, 7, 200, 800] {
            let all = fibonacci(count);
            let mean = all.iter().fold([0.0; 3], |sum, at| [0, 1, 2].map(|k| sum[k] + at[k] / count as f32));
            let dot = |a: [f32; 3], b: [f32; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            assert!(all.iter().all(|at| (dot(*at, *at) - 1.0).abs() < 1e-6), "of unit length");
            if count == 1 {
                continue;
            }
            assert!(dot(mean, mean).sqrt() < 1.0 / (count as f32), "{mean:?} of {count}");
            // A direction has an area of 4π / n to itself; the closest are 0.6 to 0.9 of the side of that apart.
            let side = (4.0 * std::f32::consts::PI / count as f32).sqrt();
            let apart = |a: usize, b: usize| (2.0 - 2.0 * dot(all[a], all[b])).max(0.0).sqrt() / side;
            let closest = (0..count).flat_map(|a| (0..a).map(move |b| apart(a, b))).fold(f32::INFINITY, f32::min);
            assert!((0.6..1.3).contains(&closest), "{closest} of {count}");
        }
    }
}
