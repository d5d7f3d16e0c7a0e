//! Twin of `shade_vertex.wgsl` and `shading.wgsl`.

use glam::Vec3;
use subsurf_scene::MAX_LIGHTS;

use super::raster::rasterise;
use super::{Reflections, display, fresnel_transmittance, incident, neutral, specular_ambient, specular_direct, srgb};
use crate::rgb::Rgb;
use crate::uniform::Blocks;

/// Mesh with the exitance of its vertices.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'a> {
    /// Positions of the vertices in mm.
    pub positions: &'a [Vec3],
    /// Unit normals of the vertices.
    pub normals: &'a [Vec3],
    /// Exitance of the vertices, linear Rec. 709.
    pub exitances: &'a [Rgb],
    /// Visibility of each light from the vertices, 0 to 1.
    pub visibilities: &'a [[f32; MAX_LIGHTS]],
    /// Numbers of the vertices of the triangles.
    pub triangles: &'a [[u32; 3]],
}

/// Picture of a mesh in display values, `size` pixels, row by row from the top, in front of a `background`.
///
/// # Panics
/// If an index leads outside the vertices.
#[must_use]
pub fn shade_vertex(
    mesh: &Triangles<'_>,
    blocks: &Blocks,
    reflections: &Reflections<'_>,
    size: [u32; 2],
    background: [u8; 3],
) -> Vec<[u8; 3]> {
    let exitances: Vec<Vec3> = mesh.exitances.iter().map(|exitance| Vec3::from(*exitance)).collect();
    rasterise(mesh.positions, mesh.triangles, &blocks.scene.clip_from_world, size, background, |covered| {
        let point = Point {
            position_mm: covered.blend(mesh.positions),
            normal: covered.blend(mesh.normals),
            exitance: covered.blend(&exitances),
            visibility: covered.blend_all(mesh.visibilities),
        };
        let light = radiance(blocks, reflections, &point) * blocks.scene.exposure;
        display(srgb(neutral(light.into())))
    })
}

/// Point of the surface.
struct Point {
    position_mm: Vec3,
    normal: Vec3,
    exitance: Vec3,
    visibility: [f32; MAX_LIGHTS],
}

/// Radiance that leaves towards the eye.
fn radiance(blocks: &Blocks, reflections: &Reflections<'_>, point: &Point) -> Vec3 {
    let object = &blocks.object;
    let to_eye = (Vec3::from(blocks.scene.eye_mm) - point.position_mm).normalize();
    let normal = point.normal.normalize();
    // Scattered light, by Lambert's law with Fresnel transmission on the way out: L = M F_t / (π (1 − F_dr)).
    let cosine = normal.dot(to_eye).abs().clamp(0.0, 1.0);
    let transmittance = fresnel_transmittance(cosine, object.eta);
    let scattered = point.exitance * transmittance / (object.sky_transmittance * std::f32::consts::PI);
    // Light that the coat reflects.
    let mirrored = (-to_eye).reflect(normal);
    let sky = specular_ambient(object, cosine) * reflections.radiance(mirrored, object.roughness);
    let lights = (0..blocks.scene.lights as usize).map(|light| {
        let (towards, irradiance) = incident(&blocks.scene, light, point.position_mm);
        irradiance * specular_direct(object, normal, to_eye, towards) * point.visibility[light]
    });
    scattered + sky + lights.sum::<Vec3>()
}
