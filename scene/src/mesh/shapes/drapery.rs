//! A cloth that hangs in folds.

use std::f32::consts::{FRAC_PI_2, PI, TAU};

use glam::Vec3;

use super::lattice::{EDGE, lattice, spans};
use crate::mesh::triangles::Mesh;

/// Round cloth of `thickness_mm` that hangs over the y axis like a bell, 1.3 · `radius_mm` high from its hem at y = 0,
/// in about `folds` folds that deepen from the top to the hem, where it is `radius_mm` wide on average; the hem is round.
/// `rings` rings of quads outside and as many inside, each of six times as many quads. The cloth is closed: it has an
/// inside. u goes around, v from the top of the inside over the hem to the top outside.
///
/// # Panics
/// If `rings` is less than 2, `folds` is 0, the thickness not positive, or the thickness times (`folds` + 2) more than
/// 0.6 · `radius_mm`: the cloth would be thicker than its folds are round.
#[must_use]
pub fn drapery(radius_mm: f32, thickness_mm: f32, folds: u16, rings: u16) -> Mesh {
    assert!(rings >= 2 && folds >= 1, "{rings} rings, {folds} folds");
    assert!(thickness_mm > 0.0, "a cloth of {thickness_mm} mm");
    let folds = f32::from(folds);
    assert!(
        thickness_mm * (folds + 2.0) <= 0.6 * radius_mm,
        "{folds} folds of {thickness_mm} mm in a cloth of {radius_mm} mm"
    );
    let half_mm = 0.5 * thickness_mm;
    // A quarter of an ellipse, nearly, and a half turn around its hem.
    let (side, hem) = (FRAC_PI_2 * 1.15 * radius_mm, PI * half_mm);
    let length = side + hem + side;
    lattice(&spans(&[(1.0, 6 * rings)]), &spans(&[(side, rings), (hem, EDGE), (side, rings)]), |uv| {
        // chi from the top to the hem of the middle of the cloth, beta from its inside around its hem to its outside.
        let at = uv.y * length;
        let chi = FRAC_PI_2 * (at.min(length - at) / side).clamp(0.0, 1.0);
        let beta = PI * ((at - side) / hem).clamp(0.0, 1.0);
        let [middle, outside, down] = cloth(chi, TAU * uv.x, folds);
        let normal = down * beta.sin() - outside * beta.cos();
        (middle * radius_mm + normal * half_mm, normal)
    })
}

/// Middle of the cloth of [`drapery`], of radius 1, its unit normal outwards, and along it and away from its hem.
fn cloth(chi: f32, phi: f32, folds: f32) -> [Vec3; 3] {
    let (sin_chi, cos_chi) = chi.sin_cos();
    let (sin_phi, cos_phi) = phi.sin_cos();
    // Folds w(φ), of which no two are alike, and how deep they are, a(χ); with slopes.
    let waves = [(folds, 0.0, 1.2), (folds + 1.0, 1.0, 0.4), (2.0, 2.0, 0.2)];
    let (mut w, mut w_phi) = (0.0, 0.0);
    for (k, phase, size) in waves {
        let (sin, cos) = (k * phi + phase).sin_cos();
        w += size / (folds + 2.0) * cos;
        w_phi -= size / (folds + 2.0) * k * sin;
    }
    let (a, a_chi) = (sin_chi.powi(2), 2.0 * sin_chi * cos_chi);
    // m = (1 + a w) sin χ outwards + 1.3 cos χ y; dm/dχ, and dm/dφ / sin χ, which does not vanish at the top.
    let (outwards, along) = (Vec3::new(sin_phi, 0.0, cos_phi), Vec3::new(cos_phi, 0.0, -sin_phi));
    let wide = 1.0 + a * w;
    let middle = outwards * (wide * sin_chi) + Vec3::Y * (1.3 * cos_chi);
    let by_chi = outwards * (wide * cos_chi + a_chi * w * sin_chi) - Vec3::Y * (1.3 * sin_chi);
    let by_phi = (outwards * (a * w_phi) + along * wide).normalize();
    let normal = by_chi.cross(by_phi).normalize();
    [middle, normal, by_phi.cross(normal)]
}
