//! Images of a mesh from random sides.

use glam::{Mat3, Vec3};
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use serde::{Deserialize, Serialize};
use subsurf_scene::Mesh;

use crate::math::parallel;

/// Pixels of one orthographic view: the triangle in front, and where on it.
struct View {
    /// Triangle and its barycentric coordinates; `None` of the background.
    pixels: Vec<Option<(u32, [f32; 3])>>,
}

/// Views of a mesh, as many as the paper has.
const VIEWS: usize = 100;
/// Sides of views in pixels.
const SIDE: u16 = 256;

/// Random views of a mesh, in which values of its vertices are looked at.
pub struct Views(Vec<View>);

/// Root-mean-square errors of images: the largest, and the one over all.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct ImageError {
    /// Of the worst view, as the paper says e_rms.
    pub max: f64,
    /// Over all views.
    pub rms: f64,
}

impl Views {
    /// The views by which all is judged.
    #[must_use]
    pub fn of(mesh: &Mesh) -> Self {
        Self::new(mesh, VIEWS, SIDE)
    }

    /// `count` views from random sides, of `side` × `side` pixels that the mesh fills.
    fn new(mesh: &Mesh, count: usize, side: u16) -> Self {
        let mut rng = Pcg64::seed_from_u64(1);
        let mut next = || 2.0 * rng.random::<f32>() - 1.0;
        let mut random = || {
            loop {
                let at = Vec3::new(next(), next(), next());
                if (0.01..1.0).contains(&at.length_squared()) {
                    break at.normalize();
                }
            }
        };
        let axes: Vec<[Vec3; 2]> = (0..count).map(|_| [random(), random()]).collect();
        Self(parallel::map(count, |view| View::new(mesh, axes[view][0], axes[view][1], side)))
    }

    /// Errors between values of vertices `[image][vertex]`, as large as 1 where images are white. The background counts and is the same
    /// in both. Views show the images in turn.
    #[must_use]
    pub fn errors(&self, mesh: &Mesh, a: &[Vec<f32>], b: &[Vec<f32>]) -> ImageError {
        let of_view = |number: usize| {
            let view = &self.0[number];
            let [a, b] = [&a[number % a.len()], &b[number % b.len()]];
            let square = |pixel: &Option<(u32, [f32; 3])>| {
                let Some((triangle, share)) = pixel else { return 0.0 };
                let corners = mesh.triangles[*triangle as usize];
                let difference: f32 =
                    (0..3).map(|k| share[k] * (a[corners[k] as usize] - b[corners[k] as usize])).sum();
                f64::from(difference).powi(2)
            };
            view.pixels.iter().map(square).sum::<f64>() / view.pixels.len() as f64
        };
        let squares = parallel::map(self.0.len(), of_view);
        let mean = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
        ImageError { max: squares.iter().copied().fold(0.0, f64::max).sqrt(), rms: mean.sqrt() }
    }

    /// Share of the pixels that the mesh covers.
    #[must_use]
    pub fn covered(&self) -> f64 {
        let pixels = self.0.iter().flat_map(|view| &view.pixels);
        let (covered, all) =
            pixels.fold((0_u64, 0_u64), |(covered, all), pixel| (covered + u64::from(pixel.is_some()), all + 1));
        covered as f64 / all.max(1) as f64
    }
}

impl ImageError {
    /// The larger of each.
    #[must_use]
    pub(crate) fn larger(self, other: Self) -> Self {
        Self { max: self.max.max(other.max), rms: self.rms.max(other.rms) }
    }
}

impl View {
    /// What is seen along `forward`, turned by `roll`.
    fn new(mesh: &Mesh, forward: Vec3, roll: Vec3, side: u16) -> Self {
        let right = (roll - roll.dot(forward) * forward).try_normalize().unwrap_or(forward.any_orthonormal_vector());
        let axes = Mat3::from_cols(right, forward.cross(right), forward).transpose();
        let sphere = mesh.bounding_sphere();
        let half = 0.5 * f32::from(side);
        // Pixels from the left and from below, and depth.
        let place = |at: &Vec3| {
            let at = axes * (*at - sphere.centre_mm) / sphere.radius_mm;
            Vec3::new(half * (1.0 + at.x), half * (1.0 + at.y), at.z)
        };
        let places: Vec<Vec3> = mesh.positions.iter().map(place).collect();
        let side = usize::from(side);
        let mut pixels = vec![None; side * side];
        let mut depths = vec![f32::INFINITY; side * side];
        for (number, corners) in (0..).zip(&mesh.triangles) {
            let [a, b, c] = corners.map(|k| places[k as usize]);
            let area = (b - a).truncate().perp_dot((c - a).truncate());
            if area == 0.0 {
                continue;
            }
            // Pixels have their middles at halves.
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the picture")]
            let pixel = |at: f32| at.clamp(0.0, side as f32) as usize;
            let [low, high] = [a.min(b).min(c), a.max(b).max(c)];
            for y in pixel((low.y - 0.5).ceil())..pixel((high.y - 0.5).floor() + 1.0) {
                for x in pixel((low.x - 0.5).ceil())..pixel((high.x - 0.5).floor() + 1.0) {
                    let at = glam::Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                    let [ta, tb, tc] = [a, b, c].map(|corner| corner.truncate() - at);
                    let share = [tb.perp_dot(tc), tc.perp_dot(ta), ta.perp_dot(tb)].map(|part| part / area);
                    let depth = share[0] * a.z + share[1] * b.z + share[2] * c.z;
                    let pixel = y * side + x;
                    if share.iter().all(|share| *share >= 0.0) && depth < depths[pixel] {
                        depths[pixel] = depth;
                        pixels[pixel] = Some((number, share));
                    }
                }
            }
        }
        Self { pixels }
    }
}

#[cfg(test)]
mod tests {
    use subsurf_scene::sphere;

    use super::*;

    #[test]
    fn a_sphere_covers_a_disc_and_errors_are_those_of_its_front() {
        let ball = sphere(3.0, 24);
        let views = Views::new(&ball, 3, 64);
        let disc = std::f64::consts::FRAC_PI_4;
        assert!((views.covered() - disc).abs() < 0.02, "{} of {disc}", views.covered());
        let flat = |value: f32| vec![value; ball.positions.len()];
        let error = views.errors(&ball, &[flat(0.5)], &[flat(0.4)]);
        assert!((error.rms - 0.1 * views.covered().sqrt()).abs() < 1e-4, "{error:?}");
        // One view is worse than the others.
        let worse = views.errors(&ball, &[0.0, 0.3, 0.0].map(flat), &[flat(0.0)]);
        assert!((worse.max / worse.rms - 3.0_f64.sqrt()).abs() < 0.05, "{worse:?}");
    }
}
