//! Where a translucent material lies on a mesh.

use subsurf_decoder::Bssrdf;
use subsurf_scene::{Mapping, Mesh};

use crate::error::{Error, Result};

/// Choice of how a translucent material lies on a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MappingChoice {
    /// Texture coordinates if the mesh has any, else [`Box`](Self::Box).
    Auto,
    /// Texture coordinates, repeated so that the material keeps its size.
    Uv,
    /// Projected from the side that each normal faces most.
    Box,
}

/// Mapping of a material onto a mesh: texture coordinates are repeated a whole number of times, so that the material has
/// its own size on average.
///
/// # Errors
/// [`Error::Request`] if texture coordinates are asked for and the mesh has none.
pub fn choose_mapping(mesh: &Mesh, choice: MappingChoice, material: &Bssrdf<'_>) -> Result<Mapping> {
    let uvs = match (choice, &mesh.uvs) {
        (MappingChoice::Uv, None) => {
            return Err(Error::Request(
                "the mesh has no texture coordinates: unwrap it in a modelling program (in Blender: Edit Mode, UV, \
                 Smart UV Project) and export them, or choose the mapping \"box\""
                    .to_owned(),
            ));
        }
        (MappingChoice::Box, _) | (MappingChoice::Auto, None) => return Ok(Mapping::Box),
        (MappingChoice::Uv | MappingChoice::Auto, Some(uvs)) => uvs,
    };
    let (mut area_mm2, mut area_uv) = (0.0_f64, 0.0_f64);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| mesh.positions[k as usize]);
        let [ta, tb, tc] = triangle.map(|k| uvs[k as usize]);
        area_mm2 += f64::from((b - a).cross(c - a).length());
        area_uv += f64::from((tb - ta).perp_dot(tc - ta).abs());
    }
    let header = material.header();
    let mm_per_unit = if area_uv > 0.0 { (area_mm2 / area_uv).sqrt() } else { 0.0 };
    #[allow(clippy::cast_possible_truncation, reason = "a small whole number")]
    let times = |side: u32| (mm_per_unit / (f64::from(side) * f64::from(header.pitch_mm))).round().max(1.0) as f32;
    Ok(Mapping::Uv([times(header.width), times(header.height)]))
}
