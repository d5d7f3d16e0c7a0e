//! Meshes from PLY, as scanners write them: ASCII or binary.

use std::fs::File;
use std::io::BufReader;
use std::path::Path;

use glam::{Vec2, Vec3};
use ply_rs_bw::parser::Parser;
use ply_rs_bw::ply::{DefaultElement, Property};

use super::raw::{Raw, Result};

/// Reads a .ply file.
pub(super) fn read(path: &Path) -> Result<Raw> {
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
