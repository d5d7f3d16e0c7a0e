//! Lights under which a patch is looked at.

use crate::metrics::bssrdf::Light;

/// Number of lights that the fit learns of.
pub(super) const LIGHTS: usize = 14;

/// Irradiance of the lights of one patch, row by row: those of the fit, uniform light first.
pub(super) fn lights(size: [usize; 2]) -> Vec<Vec<f32>> {
    let side = float(size[0].min(size[1]));
    // Radii from 4 pixels to 0.3 of the shorter side, widths of lines from 2 to 6 pixels.
    let radius = |k: f64| 4.0_f64.min(0.3 * side) * (0.3 * side / 4.0).max(1.0).powf(k / 4.0);
    let disc = |k: usize| {
        let ([x, y], r) = (place(k, size), radius(float(k)));
        drawn(size, |p| (p[0] - x).hypot(p[1] - y) <= r)
    };
    let line = |k: usize, axis: usize| {
        let (middle, half) = (place(7 + 3 * axis + k, size)[axis], 1.0 + float(k));
        drawn(size, |p| (p[axis] - middle).abs() <= half)
    };
    let half_plane = |k: usize| {
        let ([x, y], angle) = (place(15 + k, size), 0.7 + 2.0 * float(k));
        drawn(size, |p| (p[0] - x) * angle.cos() + (p[1] - y) * angle.sin() <= 0.0)
    };
    let mut all = vec![vec![1.0; size[0] * size[1]]];
    all.extend((0..5).map(disc));
    all.extend((0..3).map(|k| line(k, 0)));
    all.extend((0..3).map(|k| line(k, 1)));
    all.extend((0..2).map(half_plane));
    debug_assert_eq!(all.len(), LIGHTS, "the lights of the fit");
    all
}

/// Irradiance of the lights by which the error is judged.
pub(super) fn judges(size: [usize; 2]) -> Vec<Vec<f32>> {
    let pixels = || (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    Light::ALL.iter().map(|light| pixels().map(|pixel| light.irradiance(pixel, size)).collect()).collect()
}

/// 1 at pixels whose middle is lit, 0 elsewhere.
fn drawn(size: [usize; 2], is_lit: impl Fn([f64; 2]) -> bool) -> Vec<f32> {
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [float(x) + 0.5, float(y) + 0.5]));
    pixels.map(|pixel| f32::from(u8::from(is_lit(pixel)))).collect()
}

/// Place number `k` on the patch, spread evenly: multiples of two numbers that no pattern keeps step with.
fn place(k: usize, size: [usize; 2]) -> [f64; 2] {
    let at = |ratio: f64, side: usize| (0.5 + float(k) * ratio).fract() * float(side);
    [at(0.754_877_666, size[0]), at(0.569_840_290, size[1])]
}

/// Numbers of up to `count` pixels, all of them if there are no more; rising.
pub(super) fn spread(size: [usize; 2], count: usize) -> Vec<usize> {
    if size[0] * size[1] <= count {
        return (0..size[0] * size[1]).collect();
    }
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the patch")]
    let number = |k: usize| {
        let [x, y] = place(k, size).map(|k| k as usize);
        y.min(size[1] - 1) * size[0] + x.min(size[0] - 1)
    };
    let mut all: Vec<usize> = (0..count).map(number).collect();
    all.sort_unstable();
    all.dedup();
    all
}

#[allow(clippy::cast_precision_loss, reason = "pixels of a patch")]
fn float(k: usize) -> f64 {
    k as f64
}
