//! Meshes as files, for programs that take no others.

use std::fmt::Write as _;
use std::path::Path;

use subsurf_scene::Mesh;

/// Writes a mesh with texture coordinates as an OBJ file. Small pictures want large triangles: a software renderer shades
/// 4 × 4 pixels for each that it touches.
///
/// # Panics
/// If it has no texture coordinates, or cannot be written.
pub fn write_obj(path: &Path, mesh: &Mesh) {
    let uvs = mesh.uvs.as_ref().expect("a mesh with texture coordinates");
    let mut text = String::new();
    for ((p, n), t) in mesh.positions.iter().zip(&mesh.normals).zip(uvs) {
        writeln!(text, "v {} {} {}\nvn {} {} {}\nvt {} {}", p.x, p.y, p.z, n.x, n.y, n.z, t.x, t.y).unwrap();
    }
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| vertex + 1);
        writeln!(text, "f {a}/{a}/{a} {b}/{b}/{b} {c}/{c}/{c}").unwrap();
    }
    std::fs::write(path, text).expect("a temporary folder can be written to");
}
