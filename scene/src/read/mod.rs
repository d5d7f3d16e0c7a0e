//! Meshes from OBJ, PLY, STL, OFF and glTF files, and shapes by their names.

mod corners;
mod gltf;
mod obj;
mod off;
mod ply;
mod polygon;
mod raw;
mod stl;
mod text;

use std::path::Path;

use glam::{DVec3, Vec3};

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

/// How many times its size a mesh may be from its origin before single precision is too coarse: less than a tenth of a
/// pixel of a large picture.
const FAR: f64 = 1e3;

/// Endings of the names of mesh files.
pub const MESH_EXTENSIONS: [&str; 6] = ["obj", "ply", "stl", "off", "glb", "gltf"];

/// Mesh, and what was changed or left out of its file.
#[derive(Clone, Debug)]
pub struct LoadedMesh {
    /// The mesh, checked.
    pub mesh: Mesh,
    /// One line each, with a count where several were changed alike; without the name of the file.
    pub warnings: Vec<String>,
}

/// Mesh from a file, or the shape if `path` is one of [`SHAPES`]; its longest side is `extent_mm`, its middle the origin.
///
/// Materials, textures, colours and animations are not read: a mesh is not refused for what is not drawn. Normals that are
/// missing, zero or not finite are made anew. A mesh without texture coordinates has charts ([`Mesh::charted`]).
///
/// # Errors
/// [`Error::File`] if the file is not a mesh, or a broken one.
pub fn load_mesh(path: &Path, extent_mm: f32, up: UpAxis) -> Result<LoadedMesh> {
    if let Some(mesh) = path.to_str().and_then(shape) {
        return Ok(LoadedMesh { mesh: mesh.fitted(extent_mm)?, warnings: Vec::new() });
    }
    let wrong = |reason: String| Error::File { path: path.to_owned(), reason };
    let mut raw = read(path).map_err(wrong)?;
    raw.check().map_err(wrong)?;
    if up == UpAxis::Z {
        raw.positions.iter_mut().for_each(|v| *v = DVec3::new(v.x, v.z, -v.y));
        raw.normals.iter_mut().for_each(|v| *v = Vec3::new(v.x, v.z, -v.y));
    }
    let (positions, longest) = centred(&raw.positions);
    if !(longest.is_finite() && longest > 0.0) {
        return Err(wrong(format!("its longest side is {longest}; expected a size")));
    }
    let scale = extent_mm / longest;
    let uvs = (!raw.uvs.is_empty()).then_some(raw.uvs);
    let mesh = Mesh::new(positions, raw.normals, uvs, raw.triangles, scale);
    let mesh = mesh.map_err(|error| wrong(error.to_string()))?;
    let mesh = if mesh.uvs.is_none() { mesh.charted() } else { mesh };
    Ok(LoadedMesh { mesh, warnings: raw.warnings })
}

/// Positions around the origin, and the longest side of the box around them.
fn centred(positions: &[DVec3]) -> (Vec<Vec3>, f32) {
    let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    let middle = 0.5 * (low + high);
    if middle.abs().max_element() > FAR * (high - low).max_element() {
        let positions = positions.iter().map(|position| (position - middle).as_vec3()).collect();
        return (positions, (high - low).as_vec3().max_element());
    }
    let (low, high) = (low.as_vec3(), high.as_vec3());
    let middle = 0.5 * (low + high);
    (positions.iter().map(|position| position.as_vec3() - middle).collect(), (high - low).max_element())
}

fn read(path: &Path) -> raw::Result<raw::Raw> {
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    if !MESH_EXTENSIONS.contains(&extension.as_str()) {
        let [shapes, extensions] = [SHAPES.join(", "), MESH_EXTENSIONS.join(", .")];
        return Err(format!("not a mesh; expected a file .{extensions}, or one of the shapes {shapes}"));
    }
    let bytes = std::fs::read(path).map_err(|error| error.to_string())?;
    match extension.as_str() {
        "obj" => obj::read(&bytes),
        "ply" => ply::read(&bytes),
        "stl" => stl::read(&bytes),
        "off" => off::read(&bytes),
        _ => gltf::read(&bytes, path.parent().unwrap_or(Path::new(""))),
    }
}
