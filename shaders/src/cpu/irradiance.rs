//! Twin of `irradiance.wgsl`.

use subsurf_scene::SurfacePoints;

use super::{entering, incident, sky_irradiance};
use crate::rgb::Rgb;
use crate::uniform::Blocks;

/// Irradiance that enters at each point of a surface:
/// E = Σ F_t(cos) max(cos, 0) V E_light + T_sky E_sky.
///
/// # Panics
/// If there are more lights than a scene may have.
#[must_use]
pub fn irradiance(blocks: &Blocks, points: &SurfacePoints) -> Vec<Rgb> {
    let points = points.positions.iter().zip(&points.normals).zip(&points.visibilities);
    points
        .map(|((position, normal), seen)| {
            let normal = normal.truncate();
            let mut sum = sky_irradiance(blocks, normal);
            for light in 0..blocks.scene.lights as usize {
                let (towards, from_light) = incident(&blocks.scene, light, position.truncate());
                let share = entering(&blocks.object, normal, towards) * seen[light];
                for c in 0..3 {
                    sum[c] += from_light[c] * share;
                }
            }
            sum
        })
        .collect()
}
