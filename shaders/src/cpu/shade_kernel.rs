//! Twin of `shade_kernel.wgsl`, for maps of a texel to a pixel.

use glam::{Vec3, Vec4, Vec4Swizzles};
use subsurf_scene::MAX_LIGHTS;

use super::shading::{Point, shaded};
use super::{KernelGBuffer, Reflections, sky_irradiance};
use crate::uniform::{Blocks, KernelProfile};

/// Picture in display values, row by row from the top, in front of a `background`: `sums` are the exitance under the lights, of each pixel.
/// Light of the environment reaches everything.
#[must_use]
pub fn shade_kernel(
    gbuffer: &KernelGBuffer,
    sums: &[Vec4],
    profile: &KernelProfile,
    blocks: &Blocks,
    reflections: &Reflections<'_>,
    background: [u8; 3],
) -> Vec<[u8; 3]> {
    let reflectance = Vec4::from(profile.reflectance).xyz();
    let pixel = |(point, sum): (&Option<[Vec3; 2]>, &Vec4)| {
        let Some([position_mm, normal]) = *point else { return background };
        let sky = Vec3::from(sky_irradiance(blocks, normal));
        let exitance = (sum.xyz() + reflectance * sky).max(Vec3::ZERO);
        shaded(blocks, reflections, &Point { position_mm, normal, exitance, visibility: [1.0; MAX_LIGHTS] })
    };
    gbuffer.points.iter().zip(sums).map(pixel).collect()
}
