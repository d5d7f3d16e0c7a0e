//! Meshes from PLY, as scanners and modellers write them: in text or binary; polygons, and strips of triangles.

mod header;
mod values;

use glam::{DVec2, DVec3, Vec2};

use super::corners::Corners;
use super::raw::{Raw, Result};
use super::text::{quoted, shortened};
use header::{Element, Header};
use values::Values;

/// Names of lists of vertices.
const VERTICES: [&str; 2] = ["vertex_indices", "vertex_index"];
/// Names of the numbers of a vertex: position, normal, texture coordinates.
const NUMBERS: [&[&str]; 8] = [
    &["x"],
    &["y"],
    &["z"],
    &["nx"],
    &["ny"],
    &["nz"],
    &["u", "s", "texture_u", "texcoord_u"],
    &["v", "t", "texture_v", "texcoord_v"],
];

/// Reads the bytes of a .ply file.
pub(super) fn read(bytes: &[u8]) -> Result<Raw> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let header = Header::parse(bytes)?;
    let mut values = Values::new(&header, bytes);
    let mut out = Raw::default();
    let mut faces = Faces::default();
    let mut long = 0;
    for element in &header.elements {
        for k in 0..element.count {
            if element.properties.is_empty() {
                break;
            }
            let one = match element.name.as_str() {
                "vertex" => vertex(element, &mut values, &mut out),
                "face" => faces.add(element, &mut values),
                "tristrips" => strips(element, &mut values, &mut out),
                _ => skip(element, &mut values),
            };
            one.map_err(|error| {
                format!("{}: {error}, in {} {k} of {}", values.place(), quoted(element.name.as_bytes()), element.count)
            })?;
            long += usize::from(values.end_line());
        }
    }
    let has = |name: &str| header.elements.iter().any(|element| element.name == name && element.count > 0);
    if !has("vertex") || !(has("face") || has("tristrips")) {
        let of = |element: &Element| format!("{} {}", element.count, element.name);
        let elements: Vec<_> = header.elements.iter().map(of).collect();
        let elements = if elements.is_empty() { "none".to_owned() } else { shortened(&elements.join(", "), 160) };
        return Err(format!("has the elements: {elements}; expected vertex, and face or tristrips"));
    }
    out.leave_out(long, "lines longer than the header says, their ends");
    faces.finish(&mut out)?;
    Ok(out)
}

/// Reads the numbers of an element one after the other, and its lists by `list`.
fn properties(
    element: &Element,
    values: &mut Values<'_>,
    mut number: impl FnMut(&str, f64),
    mut list: impl FnMut(&str, Vec<f64>),
) -> Result<()> {
    for property in &element.properties {
        match property.length {
            None => number(&property.name, values.value(property.value)?),
            Some(length) => {
                let length = values.length(length)?;
                let mut items = Vec::new();
                for _ in 0..length {
                    items.push(values.value(property.value)?);
                }
                list(&property.name, items);
            }
        }
    }
    Ok(())
}

fn skip(element: &Element, values: &mut Values<'_>) -> Result<()> {
    properties(element, values, |_, _| (), |_, _| ())
}

fn vertex(element: &Element, values: &mut Values<'_>, out: &mut Raw) -> Result<()> {
    let mut numbers = [None; NUMBERS.len()];
    let number = |name: &str, value: f64| {
        if let Some(slot) = NUMBERS.iter().position(|names| names.contains(&name)) {
            numbers[slot].get_or_insert(value);
        }
    };
    properties(element, values, number, |_, _| ())?;
    let [x, y, z, nx, ny, nz, u, v] = numbers;
    let vector = |x: Option<f64>, y: Option<f64>, z: Option<f64>| Some(DVec3::new(x?, y?, z?));
    out.positions.push(vector(x, y, z).ok_or("a vertex without x, y and z")?);
    out.normals.extend(vector(nx, ny, nz).map(|normal| normal.as_vec3()));
    out.uvs.extend(u.zip(v).map(|(u, v)| DVec2::new(u, v).as_vec2()));
    Ok(())
}

/// Triangles of strips; -1 ends a strip.
fn strips(element: &Element, values: &mut Values<'_>, out: &mut Raw) -> Result<()> {
    let mut strips = Vec::new();
    properties(
        element,
        values,
        |_, _| (),
        |name, list| {
            if VERTICES.contains(&name) {
                strips = list;
            }
        },
    )?;
    for strip in strips.split(|index| *index == -1.0) {
        let strip = strip.iter().map(|index| vertex_number(*index)).collect::<Result<Vec<_>>>()?;
        out.add_strip(&strip);
    }
    Ok(())
}

/// Polygons, before the positions of all vertices are known.
#[derive(Default)]
struct Faces {
    corners: Vec<u32>,
    /// Texture coordinates of the corners; v upwards.
    uvs: Vec<Vec2>,
    /// Whether faces have texture coordinates of their own.
    has_uvs: bool,
    /// Where the corners of each face end.
    ends: Vec<usize>,
}

impl Faces {
    fn add(&mut self, element: &Element, values: &mut Values<'_>) -> Result<()> {
        let mut named = None;
        let mut uvs = Vec::new();
        properties(
            element,
            values,
            |_, _| (),
            |name, list| match name {
                name if VERTICES.contains(&name) => named = Some(list),
                "texcoord" => uvs = list,
                _ => {}
            },
        )?;
        let named = named.ok_or_else(|| format!("a face without a list {}", VERTICES.join(" or ")))?;
        for index in &named {
            self.corners.push(vertex_number(*index)?);
        }
        self.ends.push(self.corners.len());
        self.has_uvs |= !uvs.is_empty();
        self.uvs.extend(uvs.as_chunks().0.iter().take(named.len()).map(|&[u, v]| DVec2::new(u, v).as_vec2()));
        self.uvs.resize(self.corners.len(), Vec2::NAN);
        Ok(())
    }

    /// Triangles of all faces.
    fn finish(mut self, out: &mut Raw) -> Result<()> {
        if let Some(vertex) = self.corners.iter().find(|&&vertex| vertex as usize >= out.positions.len()) {
            return Err(format!("a face names vertex {vertex}, counted from 0; there are {}", out.positions.len()));
        }
        // Strips have none of their own.
        if self.has_uvs && out.triangles.is_empty() {
            self.split(out)?;
        }
        let (mut first, mut small) = (0, 0);
        for (face, &end) in self.ends.iter().enumerate() {
            let corners = &self.corners[first..end];
            first = end;
            small += usize::from(corners.len() < 3);
            out.add_polygon(corners).map_err(|error| format!("face {face}, counted from 0: {error}"))?;
        }
        out.leave_out(small, "faces of fewer than three corners");
        Ok(())
    }

    /// Makes a vertex of each combination of a vertex and its texture coordinates in faces.
    fn split(&mut self, out: &mut Raw) -> Result<()> {
        let old = std::mem::take(&mut out.positions);
        let normals = std::mem::take(&mut out.normals);
        out.uvs.clear();
        let mut vertices = Corners::new();
        for (corner, uv) in self.corners.iter_mut().zip(&self.uvs) {
            let k = *corner as usize;
            *corner = vertices.number((k, uv.to_array().map(f32::to_bits)), || {
                out.positions.push(old[k]);
                out.normals.extend(normals.get(k));
                out.uvs.push(*uv);
            })?;
        }
        Ok(())
    }
}

fn vertex_number(index: f64) -> Result<u32> {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and within 32 bits")]
    if index.fract() == 0.0 && (0.0..4_294_967_295.0).contains(&index) {
        return Ok(index as u32);
    }
    Err(format!("a vertex of number {index}"))
}
