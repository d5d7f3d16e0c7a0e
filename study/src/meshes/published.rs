//! What Hao and Varshney 2004 report of their meshes.

/// Mesh of their Table I.
pub(super) struct Published {
    pub(super) name: &'static str,
    pub(super) vertices: usize,
    pub(super) points: usize,
    /// Bytes per vertex, without numbers of reference points.
    pub(super) bytes: u32,
}

const fn row(name: &'static str, vertices: usize, points: usize, bytes: u32) -> Published {
    Published { name, vertices, points, bytes }
}

/// Their Table I.
pub(super) const TABLE: [Published; 6] = [
    row("horse", 14_521, 1_034, 27),
    row("Venus", 42_656, 2_827, 26),
    row("Santa", 75_781, 3_458, 22),
    row("teapot", 150_510, 5_176, 20),
    row("dragon", 437_645, 10_285, 18),
    row("Buddha", 543_652, 12_330, 18),
];

/// Their teapot in 9 functions, Figures 9 and 10: reference points, e_rms of the worst view.
pub(super) const TEAPOT: [(f64, f64); 5] =
    [(390.0, 0.010), (614.0, 0.0065), (1_264.0, 0.0034), (2_526.0, 0.0022), (5_176.0, 0.0017)];

/// Their teapot in spherical harmonics, Figure 6: bytes per vertex, e_rms of the worst view.
pub(super) const TEAPOT_HARMONICS: [(f64, f64); 7] =
    [(2.0, 0.18), (8.0, 0.072), (18.0, 0.027), (32.0, 0.020), (50.0, 0.012), (72.0, 0.0096), (98.0, 0.0056)];

/// Their e_rms of the worst view with 200 lights, Figure 5, and their SNR in dB of a byte for each light, section 4.
pub(super) const INTERPOLATION: f64 = 3e-3;
pub(super) const LLOYD_SNR_DB: f64 = 50.99;

/// Reference points for a mesh of that many vertices: the power of vertices that goes through the first and the last of their table, and
/// within a quarter of the others.
pub(super) fn reference_points(vertices: usize) -> usize {
    let [first, .., last] = &TABLE;
    let ratio = |of: &dyn Fn(&Published) -> usize| of(last) as f64 / of(first) as f64;
    let power = ratio(&|of| of.points).ln() / ratio(&|of| of.vertices).ln();
    let points = first.points as f64 * (vertices as f64 / first.vertices as f64).powf(power);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand")]
    let points = points.round() as usize;
    points.max(8)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reference_points_are_about_theirs() {
        for Published { name, vertices, points, .. } in &TABLE {
            let ratio = reference_points(*vertices) as f64 / *points as f64;
            assert!((0.75..1.05).contains(&ratio), "{name}: {ratio}");
        }
    }
}
