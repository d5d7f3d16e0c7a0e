//! Meshes from files, and which of their vertices a light reaches.

mod formats;
mod shadow;

use std::path::Path;

use glam::{Vec2, Vec3};
use subsurf_runtime::scene::{Mesh, bowl, drapery, knot, relief, sphere, torus};

use crate::program::failure::bad_request;
pub(crate) use shadow::visibility;

/// A mesh as files have it.
#[derive(Debug, Default)]
struct Raw {
    positions: Vec<Vec3>,
    normals: Vec<Vec3>,
    uvs: Option<Vec<Vec2>>,
    triangles: Vec<[u32; 3]>,
}

/// Which way is up in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum Up {
    /// As in glTF and most OBJ files
    Y,
    /// As in most scans and CAD files
    Z,
}

/// Shapes that need no file.
pub(crate) const SHAPES: [&str; 6] = ["knot", "bowl", "drapery", "relief", "sphere", "torus"];

/// A shape by its name, smooth enough for a large picture.
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

/// A mesh whose longest side is `extent_mm`, its middle at the origin.
pub(crate) fn fitted(mesh: Mesh, extent_mm: f32) -> anyhow::Result<Mesh> {
    let [low, high] = mesh.bounds();
    let middle = 0.5 * (low + high);
    let positions = mesh.positions.iter().map(|position| *position - middle).collect();
    let scale = extent_mm / (high - low).max_element();
    Ok(Mesh::new(positions, mesh.normals, mesh.uvs, mesh.triangles, scale)?)
}

/// What to call what is in a file.
pub(crate) fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

/// Reads a mesh, or makes one of [`SHAPES`], and scales its longest side to `extent_mm`, its middle at the origin.
pub(crate) fn load(path: &Path, extent_mm: f32, up: Up) -> anyhow::Result<Mesh> {
    if let Some(mesh) = path.to_str().and_then(shape) {
        return fitted(mesh, extent_mm);
    }
    let extension = path.extension().and_then(|extension| extension.to_str()).unwrap_or("").to_ascii_lowercase();
    let raw = match extension.as_str() {
        "obj" => formats::obj(path),
        "ply" => formats::ply(path),
        "glb" | "gltf" => formats::gltf(path),
        _ => Err(format!("unknown kind of file, and none of the shapes {}", SHAPES.join(", "))),
    };
    let mut raw = raw.map_err(|reason| {
        bad_request(format!("{}: {reason}; expected a mesh in .obj, .ply, .glb or .gltf", path.display()))
    })?;
    if up == Up::Z {
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
    mesh.map_err(|error| bad_request(format!("{}: {error}", path.display())))
}
