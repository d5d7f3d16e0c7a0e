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
    let mm_per_unit = match (choice, mesh.mm_per_uv()) {
        (MappingChoice::Uv, None) => {
            return Err(Error::Request(
                "the mesh has no texture coordinates: unwrap it in a modelling program (in Blender: Edit Mode, UV, \
                 Smart UV Project) and export them, or choose the mapping \"box\""
                    .to_owned(),
            ));
        }
        (MappingChoice::Box, _) | (MappingChoice::Auto, None) => return Ok(Mapping::Box),
        (MappingChoice::Uv | MappingChoice::Auto, Some(mm)) => f64::from(mm),
    };
    let header = material.header();
    #[allow(clippy::cast_possible_truncation, reason = "a small whole number")]
    let times = |side: u32| (mm_per_unit / (f64::from(side) * f64::from(header.pitch_mm))).round().max(1.0) as f32;
    Ok(Mapping::Uv([times(header.width), times(header.height)]))
}
