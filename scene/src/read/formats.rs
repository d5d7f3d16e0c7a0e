//! OBJ, PLY and glTF, each by its crate.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use glam::{Mat4, Vec2, Vec3};
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};

use super::Raw;

type Result<T> = std::result::Result<T, String>;

pub(super) fn obj(path: &Path) -> Result<Raw> {
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

pub(super) fn ply(path: &Path) -> Result<Raw> {
    let file = File::open(path).map_err(|error| error.to_string())?;
    let parsed = Parser::<DefaultElement>::new().read_ply(&mut BufReader::new(file));
    let parsed = parsed.map_err(|error| error.to_string())?;
    let vertices = parsed.payload.get("vertex").ok_or("no vertices")?;
    let faces = parsed.payload.get("face").ok_or("no faces")?;

    let mut out = Raw::default();
    let mut uvs = Vec::new();
    for vertex in vertices {
        let numbers = |names: [&str; 3]| -> Option<Vec3> {
            let [x, y, z] = names.map(|name| vertex.get(name).and_then(float));
            Some(Vec3::new(x?, y?, z?))
        };
        out.positions.push(numbers(["x", "y", "z"]).ok_or("a vertex without x, y and z")?);
        out.normals.extend(numbers(["nx", "ny", "nz"]));
        let uv = [["u", "s", "texture_u"], ["v", "t", "texture_v"]];
        let [u, v] = uv.map(|names| names.iter().find_map(|name| vertex.get(*name).and_then(float)));
        uvs.extend(u.zip(v).map(|(u, v)| Vec2::new(u, v)));
    }
    out.uvs = (uvs.len() == out.positions.len()).then_some(uvs);
    for face in faces {
        let list = ["vertex_indices", "vertex_index"].iter().find_map(|name| face.get(*name));
        let corners = list.and_then(indices).ok_or("a face without a list of vertices")?;
        // A fan around the first corner.
        out.triangles.extend((1..corners.len().saturating_sub(1)).map(|k| [corners[0], corners[k], corners[k + 1]]));
    }
    Ok(out)
}

fn float(property: &Property) -> Option<f32> {
    match property {
        Property::Float(value) => Some(*value),
        #[allow(clippy::cast_possible_truncation, reason = "positions are drawn in f32")]
        Property::Double(value) => Some(*value as f32),
        _ => None,
    }
}

fn indices(property: &Property) -> Option<Vec<u32>> {
    let signed = |values: &[i64]| values.iter().map(|&value| u32::try_from(value).ok()).collect();
    match property {
        Property::ListInt(values) => signed(&values.iter().map(|&value| value.into()).collect::<Vec<i64>>()),
        Property::ListShort(values) => signed(&values.iter().map(|&value| value.into()).collect::<Vec<i64>>()),
        Property::ListUInt(values) => Some(values.clone()),
        Property::ListUShort(values) => Some(values.iter().map(|&value| value.into()).collect()),
        Property::ListUChar(values) => Some(values.iter().map(|&value| value.into()).collect()),
        _ => None,
    }
}

pub(super) fn gltf(path: &Path) -> Result<Raw> {
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

fn count(n: usize) -> Result<u32> {
    u32::try_from(n).map_err(|_| "more than 2³² vertices".to_owned())
}
