//! Twin of `shade.wgsl`, with the rasteriser that the GPU has built in.

use glam::{Mat4, Vec2, Vec3, Vec4, Vec4Swizzles};

use super::{Reflections, Rgb, display, fresnel_transmittance, glint, incident, neutral, sheen, srgb};
use crate::uniform::{MAX_LIGHTS, Scene};

/// A mesh to draw.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'a> {
    /// Positions of the vertices in mm.
    pub positions: &'a [Vec3],
    /// Unit normals of the vertices.
    pub normals: &'a [Vec3],
    /// Exitance of the vertices.
    pub exitances: &'a [Rgb],
    /// How much of each light reaches the vertices.
    pub visibilities: &'a [[f32; MAX_LIGHTS]],
    /// Vertices of the triangles.
    pub triangles: &'a [[u32; 3]],
}

/// Draws a mesh in front of a `background` of display values, `size` pixels, row by row from the top.
///
/// # Panics
/// If an index leads outside the vertices.
#[must_use]
pub fn shade(
    mesh: &Triangles<'_>,
    scene: &Scene,
    reflections: &Reflections<'_>,
    size: [u32; 2],
    background: [u8; 3],
) -> Vec<[u8; 3]> {
    let [width, height] = size.map(|n| n as usize);
    let mut picture = vec![background; width * height];
    let mut depth = vec![1.0_f32; width * height];
    let clip_from_world = Mat4::from_cols_array_2d(&scene.clip_from_world);
    let clip: Vec<Vec4> = mesh.positions.iter().map(|p| clip_from_world * p.extend(1.0)).collect();
    #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
    let half = Vec2::new(width as f32, height as f32) * 0.5;
    // Pixels, y down.
    let screen = |v: Vec4| (v.xy() / v.w * Vec2::new(1.0, -1.0) + 1.0) * half;

    for triangle in mesh.triangles {
        let corners = triangle.map(|k| k as usize);
        let clip = corners.map(|k| clip[k]);
        // Cameras stand outside what they look at: a triangle that reaches behind the eye is not drawn.
        if clip.iter().any(|v| v.w <= 0.0) {
            continue;
        }
        let [a, b, c] = clip.map(screen);
        let area = (b - a).perp_dot(c - a);
        if area == 0.0 {
            continue;
        }
        let low = a.min(b).min(c).max(Vec2::ZERO);
        let high = a.max(b).max(c).min(2.0 * half - 1.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped to the picture")]
        let range = |low: f32, high: f32| low.floor() as usize..=high.ceil().max(0.0) as usize;
        for y in range(low.y, high.y) {
            for x in range(low.x, high.x) {
                if x >= width || y >= height {
                    continue;
                }
                #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
                let centre = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let weights = [
                    (c - b).perp_dot(centre - b) / area,
                    (a - c).perp_dot(centre - c) / area,
                    (b - a).perp_dot(centre - a) / area,
                ];
                if weights.iter().any(|w| *w < 0.0) {
                    continue;
                }
                // Depth is linear on the screen, everything else after division by w.
                let z: f32 = weights.iter().zip(clip).map(|(w, v)| w * v.z / v.w).sum();
                let at = y * width + x;
                if !(0.0..depth[at]).contains(&z) {
                    continue;
                }
                depth[at] = z;
                let mut perspective = [0, 1, 2].map(|k| weights[k] / clip[k].w);
                let sum: f32 = perspective.iter().sum();
                perspective = perspective.map(|w| w / sum);
                let blend = |values: &[Vec3]| -> Vec3 {
                    (0..3).map(|k| values[corners[k]] * perspective[k]).fold(Vec3::ZERO, |sum, v| sum + v)
                };
                let exitance: Vec3 = (0..3)
                    .map(|k| Vec3::from(mesh.exitances[corners[k]]) * perspective[k])
                    .fold(Vec3::ZERO, |sum, v| sum + v);
                let visibility = (0..3).fold([0.0; MAX_LIGHTS], |sum, k| {
                    let of_corner = mesh.visibilities[corners[k]];
                    std::array::from_fn(|light| sum[light] + of_corner[light] * perspective[k])
                });
                let point =
                    Point { position_mm: blend(mesh.positions), normal: blend(mesh.normals), exitance, visibility };
                let light = radiance(scene, reflections, &point) * scene.exposure;
                picture[at] = display(srgb(neutral(light.into())));
            }
        }
    }
    picture
}

/// What is known of a point of the surface.
struct Point {
    position_mm: Vec3,
    normal: Vec3,
    exitance: Vec3,
    visibility: [f32; MAX_LIGHTS],
}

/// Radiance that leaves towards the eye.
fn radiance(scene: &Scene, reflections: &Reflections<'_>, point: &Point) -> Vec3 {
    let to_eye = (Vec3::from(scene.eye_mm) - point.position_mm).normalize();
    let normal = point.normal.normalize();
    // What scattered, by Lambert's law with Fresnel transmission on the way out: L = M F_t / (π (1 − F_dr)).
    let cosine = normal.dot(to_eye).abs().clamp(0.0, 1.0);
    let transmittance = fresnel_transmittance(cosine, scene.eta);
    let scattered = point.exitance * transmittance / (scene.sky_transmittance * std::f32::consts::PI);
    // What the coat reflects.
    let mirrored = (-to_eye).reflect(normal);
    let sky = sheen(scene, cosine) * reflections.radiance(mirrored, scene.roughness);
    let lights = (0..scene.lights as usize).map(|light| {
        let (towards, irradiance) = incident(scene, light, point.position_mm);
        irradiance * glint(scene, normal, to_eye, towards) * point.visibility[light]
    });
    scattered + sky + lights.sum::<Vec3>()
}
