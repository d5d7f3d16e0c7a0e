//! Meshes from glTF 2.0: all triangles of the default scene, in the places where its nodes put them.

use std::path::Path;

use glam::{Mat4, Vec2};

use super::raw::{Raw, Result, count};

/// Reads a .gltf or .glb file.
pub(super) fn read(path: &Path) -> Result<Raw> {
    let gltf::Gltf { document, blob } = gltf::Gltf::open(path).map_err(|error| error.to_string())?;
    let buffers = gltf::import_buffers(&document, path.parent(), blob).map_err(|error| error.to_string())?;
    let scene = document.default_scene().or_else(|| document.scenes().next()).ok_or("no scene")?;
    let mut out = Raw { uvs: Some(Vec::new()), ..Raw::default() };
    let mut nodes: Vec<(gltf::Node<'_>, Mat4)> = scene.nodes().map(|node| (node, Mat4::IDENTITY)).collect();
    let mut visited = std::collections::HashSet::new();
    while let Some((node, parent)) = nodes.pop() {
        if !visited.insert(node.index()) {
            return Err(format!("node {} is in the scene twice; nodes make a tree", node.index()));
        }
        let world = parent * Mat4::from_cols_array_2d(&node.transform().matrix());
        nodes.extend(node.children().map(|child| (child, world)));
        for primitive in node.mesh().into_iter().flat_map(|mesh| mesh.primitives().collect::<Vec<_>>()) {
            add_primitive(&primitive, &buffers, world, &mut out)?;
        }
    }
    // Only of use if every vertex has them.
    out.uvs = out.uvs.filter(|uvs| uvs.len() == out.positions.len());
    Ok(out)
}

fn add_primitive(
    primitive: &gltf::Primitive<'_>,
    buffers: &[gltf::buffer::Data],
    world: Mat4,
    out: &mut Raw,
) -> Result<()> {
    if primitive.mode() != gltf::mesh::Mode::Triangles {
        return Ok(());
    }
    let first = count(out.positions.len())?;
    let reader = primitive.reader(|buffer| buffers.get(buffer.index()).map(|data| &data.0[..]));
    let positions = reader.read_positions().ok_or("a primitive without positions")?;
    out.positions.extend(positions.map(|position| world.transform_point3(position.into())));
    let normals = reader.read_normals().into_iter().flatten();
    let upright = world.inverse().transpose();
    out.normals.extend(normals.map(|normal| upright.transform_vector3(normal.into()).normalize_or_zero()));
    if let (Some(uvs), Some(texture)) = (&mut out.uvs, reader.read_tex_coords(0)) {
        // glTF counts v downwards.
        uvs.extend(texture.into_f32().map(|[u, v]| Vec2::new(u, 1.0 - v)));
    }
    let last = count(out.positions.len())?;
    let indices: Vec<u32> = match reader.read_indices() {
        Some(indices) => indices.into_u32().map(|index| index.saturating_add(first)).collect(),
        None => (first..last).collect(),
    };
    out.triangles.extend(indices.as_chunks().0);
    Ok(())
}
