//! Meshes from OBJ, PLY and glTF files, and shapes by their names.

mod gltf;
mod obj;
mod ply;
mod raw;

use std::path::Path;

use glam::Vec3;

use crate::error::{Error, Result};
use crate::mesh::{Mesh, bowl, drapery, knot, relief, sphere, torus};

/// Axis that points up in a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UpAxis {
    /// Axis y, as in glTF and most OBJ files.
    Y,
    /// Axis z, as in most scans and CAD files.
    Z,
}

/// Names of the shapes that need no file.
pub const SHAPES: [&str; 6] = ["knot", "bowl", "drapery", "relief", "sphere", "torus"];

/// Shape of a name, smooth enough for a large picture.
fn shape(name: &str) -> Option<Mesh> {
    Some(match name {
        "knot" => knot(20.0, 6.0, 40),
        "bowl" => bowl(20.0, 2.0, 56),
        "drapery" => drapery(20.0, 1.2, 7, 70),
        "relief" => relief(20.0, 8, 120),
        "sphere" => sphere(20.0, 64),
        "torus" => torus(18.0, 8.0, 64),
        _ => return None,
    })
}

/// Mesh from a file, or the shape if `path` is one of [`SHAPES`]; its longest side is `extent_mm`, its middle the origin.
///
/// # Errors
/// [`Error::File`] if the file is not a mesh, or a broken one.
pub fn load_mesh(path: &Path, extent_mm: f32, up: UpAxis) -> Result<Mesh> {
    if let Some(mesh) = path.to_str().and_then(shape) {
        return mesh.fitted(extent_mm);
    }
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    let raw = match extension.as_str() {
        "obj" => obj::read(path),
        "ply" => ply::read(path),
        "glb" | "gltf" => gltf::read(path),
        _ => Err(format!("unknown kind of file, and none of the shapes {}", SHAPES.join(", "))),
    };
    let wrong = |reason: String| Error::File { path: path.to_owned(), reason };
    let mut raw = raw.map_err(|reason| wrong(format!("{reason}; expected a mesh in .obj, .ply, .glb or .gltf")))?;
    if up == UpAxis::Z {
        for v in raw.positions.iter_mut().chain(&mut raw.normals) {
            *v = Vec3::new(v.x, v.z, -v.y);
        }
    }
    let low = raw.positions.iter().copied().fold(Vec3::INFINITY, Vec3::min);
    let high = raw.positions.iter().copied().fold(Vec3::NEG_INFINITY, Vec3::max);
    let middle = 0.5 * (low + high);
    for position in &mut raw.positions {
        *position -= middle;
    }
    let scale = extent_mm / (high - low).max_element();
    let mesh = Mesh::new(raw.positions, raw.normals, raw.uvs, raw.triangles, scale);
    mesh.map_err(|error| wrong(error.to_string()))
}
