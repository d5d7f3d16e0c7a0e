//! Twin of `shading.wgsl`.

use glam::Vec3;
use subsurf_scene::MAX_LIGHTS;

use super::coat::leaving;
use super::{Reflections, display, incident, neutral, specular_ambient, specular_direct, srgb};
use crate::uniform::Blocks;

/// Point of the surface.
pub(super) struct Point {
    pub(super) position_mm: Vec3,
    pub(super) normal: Vec3,
    pub(super) exitance: Vec3,
    pub(super) visibility: [f32; MAX_LIGHTS],
}

/// Display values of the light that leaves towards the eye.
pub(super) fn shaded(blocks: &Blocks, reflections: &Reflections<'_>, point: &Point) -> [u8; 3] {
    let light = radiance(blocks, reflections, point) * blocks.scene.exposure;
    display(srgb(neutral(light.into())))
}

/// Radiance that leaves towards the eye.
fn radiance(blocks: &Blocks, reflections: &Reflections<'_>, point: &Point) -> Vec3 {
    let object = &blocks.object;
    let to_eye = (Vec3::from(blocks.scene.eye_mm) - point.position_mm).normalize();
    let normal = point.normal.normalize();
    // Scattered light, by Lambert's law with the coat's transmission on the way out.
    let reflectance = specular_ambient(object, normal.dot(to_eye).abs().clamp(0.0, 1.0));
    let scattered = point.exitance * leaving(object, reflectance) / std::f32::consts::PI;
    // Light that the coat reflects.
    let mirrored = (-to_eye).reflect(normal);
    let sky = reflectance * reflections.radiance(mirrored, object.roughness);
    let lights = (0..blocks.scene.lights as usize).map(|light| {
        let (towards, irradiance) = incident(&blocks.scene, light, point.position_mm);
        irradiance * specular_direct(object, normal, to_eye, towards) * point.visibility[light]
    });
    scattered + sky + lights.sum::<Vec3>()
}
