//! Meshes of every kind: what is read rightly, what is refused and how, and mutations.

mod gltf;
mod gltf_file;
mod mutations;
mod others;
mod polygons;
mod text;

use glam::Vec3;
use subsurf_scene::{LoadedMesh, UpAxis, load_mesh};

/// Name and bytes of a file.
pub(super) type Named<'a> = (&'a str, Vec<u8>);

/// Loads the first of some files; its longest side is 1 mm.
pub(super) fn load(files: &[Named<'_>]) -> Result<LoadedMesh, String> {
    let folder = tempfile::tempdir().unwrap();
    for (name, bytes) in files {
        std::fs::write(folder.path().join(name), bytes).unwrap();
    }
    load_mesh(&folder.path().join(files[0].0), 1.0, UpAxis::Y).map_err(|error| error.to_string())
}

/// Loads the first of some files and takes it for the unit square that is seen from z, whatever its vertices are; returns
/// the warnings.
pub(super) fn assert_square(what: &str, files: &[Named<'_>]) -> Vec<String> {
    let LoadedMesh { mesh, warnings } = load(files).unwrap_or_else(|error| panic!("{what}: {error}"));
    let [low, high] = mesh.bounds();
    assert!(low.abs_diff_eq(Vec3::new(-0.5, -0.5, 0.0), 1e-3), "{what}: from {low}");
    assert!(high.abs_diff_eq(Vec3::new(0.5, 0.5, 0.0), 1e-3), "{what}: to {high}");
    assert_area(what, &mesh, 1.0);
    for normal in &mesh.normals {
        assert!(normal.z > 0.99, "{what}: a normal {normal}");
    }
    warnings
}

/// The triangles of a mesh have an area in mm², and all of them show their outside to z.
pub(super) fn assert_area(what: &str, mesh: &subsurf_scene::Mesh, area: f32) {
    let (mut sizes, mut towards_z) = (0.0, 0.0);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| mesh.positions[k as usize]);
        let normal = 0.5 * (b - a).cross(c - a);
        sizes += normal.length();
        towards_z += normal.z;
    }
    assert!((sizes - area).abs() < 2e-3 && (towards_z - area).abs() < 2e-3, "{what}: {sizes}, {towards_z}; not {area}");
}

/// Loads the first of some files, which is refused in one line that has all of `parts`.
pub(super) fn assert_refused(what: &str, files: &[Named<'_>], parts: &[&str]) {
    let message = load(files).err().unwrap_or_else(|| panic!("{what}: is read"));
    assert!(message.lines().count() == 1, "{what}: {message}");
    for part in parts {
        assert!(message.contains(part), "{what}: no \"{part}\" in {message}");
    }
}
