//! Meshes from Wavefront OBJ: all groups together.

use std::path::Path;

use glam::{Vec2, Vec3};

use super::raw::{Raw, Result, count};

/// Reads an .obj file.
pub(super) fn read(path: &Path) -> Result<Raw> {
    let options = tobj::LoadOptions { single_index: true, triangulate: true, ..Default::default() };
    let (models, _) = tobj::load_obj(path, &options).map_err(|error| error.to_string())?;
    let mut out = Raw::default();
    let textured = models.iter().all(|model| !model.mesh.texcoords.is_empty());
    let smooth = models.iter().all(|model| !model.mesh.normals.is_empty());
    let mut uvs = Vec::new();
    for tobj::Model { mesh, .. } in &models {
        let first = count(out.positions.len())?;
        out.positions.extend(mesh.positions.as_chunks().0.iter().map(|&xyz| Vec3::from(xyz)));
        if smooth {
            out.normals.extend(mesh.normals.as_chunks().0.iter().map(|&xyz| Vec3::from(xyz)));
        }
        uvs.extend(mesh.texcoords.as_chunks().0.iter().map(|&uv| Vec2::from(uv)));
        out.triangles.extend(mesh.indices.as_chunks().0.iter().map(|&[a, b, c]| [a + first, b + first, c + first]));
    }
    out.uvs = textured.then_some(uvs);
    Ok(out)
}
