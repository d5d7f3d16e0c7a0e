//! Meshes from Wavefront OBJ: all groups together, each with vertices of its own, so that made normals are sharp between
//! them. Materials are not drawn and not read.

use std::collections::BTreeMap;

use glam::{DVec2, DVec3, Vec2, Vec3};

use super::corners::Corners;
use super::raw::{Raw, Result};
use super::text::{Lines, has_comment, numbers, quoted, without_mark, words};

/// What a corner does not name.
const NONE: u32 = u32::MAX;
/// Names of the three numbers of a corner, and of the lines that they count.
const PARTS: [(&str, &str); 3] = [("vertex", "v"), ("texture coordinate", "vt"), ("normal", "vn")];

/// Corner of a face: numbers of its position, texture coordinate and normal, from 0.
type Corner = [u32; 3];

/// What a file has, in its order.
#[derive(Default)]
struct Lists {
    positions: Vec<DVec3>,
    uvs: Vec<Vec2>,
    normals: Vec<Vec3>,
    corners: Vec<Corner>,
    /// Line of each face, and where its corners end.
    faces: Vec<(usize, usize)>,
    /// Faces before which a group begins.
    groups: Vec<usize>,
    small: usize,
    /// Counts of elements that are no faces.
    others: BTreeMap<&'static str, usize>,
}

/// Reads the bytes of an .obj file.
pub(super) fn read(bytes: &[u8]) -> Result<Raw> {
    let text = without_mark(bytes);
    let mut lists = Lists::default();
    let mut lines = Lines::new(&text);
    while let Some((number, line)) = lines.next() {
        let mut line = std::borrow::Cow::Borrowed(line);
        // What follows a line that ends so is part of it; a comment is at its end, whatever it ends with.
        while line.last() == Some(&b'\\') && !has_comment(&line) {
            let line = line.to_mut();
            line.pop();
            line.push(b' ');
            match lines.next() {
                Some((_, more)) => line.extend_from_slice(more),
                None => break,
            }
        }
        lists.add(number, &line).map_err(|error| format!("line {number}: {error}"))?;
    }
    lists.mesh()
}

impl Lists {
    fn add(&mut self, number: usize, line: &[u8]) -> Result<()> {
        let mut words = words(line);
        match words.next() {
            Some(b"v") => {
                let Some(position) = numbers(&mut words)? else {
                    return Err("a vertex of fewer than three numbers; expected v X Y Z".to_owned());
                };
                let rest: Vec<&[u8]> = words.collect();
                // A fourth number is a weight; three more are a colour.
                let weight = if rest.len() == 1 { numbers(rest.into_iter())?.map(|[weight]| weight) } else { None };
                let position = DVec3::from(position);
                self.positions
                    .push(weight.filter(|weight| *weight != 0.0).map_or(position, |weight| position / weight));
            }
            Some(b"vt") => {
                let rest: Vec<&[u8]> = words.collect();
                let uv = match rest.len() {
                    1 => numbers(rest.into_iter())?.map(|[u]| DVec2::new(u, 0.0)),
                    _ => numbers(rest.into_iter())?.map(DVec2::from),
                };
                self.uvs.push(uv.ok_or("a texture coordinate without numbers; expected vt U V")?.as_vec2());
            }
            Some(b"vn") => {
                let normal = numbers(words)?.map(DVec3::from);
                self.normals.push(normal.ok_or("a normal of fewer than three numbers; expected vn X Y Z")?.as_vec3());
            }
            Some(b"f" | b"fo") => {
                let first = self.corners.len();
                for word in words {
                    let corner = self.corner(word)?;
                    self.corners.push(corner);
                }
                if self.corners.len() < first + 3 {
                    self.corners.truncate(first);
                    self.small += 1;
                } else {
                    self.faces.push((number, self.corners.len()));
                }
            }
            Some(b"o" | b"g") => self.groups.push(self.faces.len()),
            Some(b"l" | b"p") => *self.others.entry("lines and points").or_default() += 1,
            Some(b"curv" | b"curv2" | b"surf") => *self.others.entry("free-form curves and surfaces").or_default() += 1,
            _ => {}
        }
        Ok(())
    }

    /// Corner as faces name it: V, V/VT, V//VN or V/VT/VN; from 1, or from the end if negative.
    fn corner(&self, word: &[u8]) -> Result<Corner> {
        let so_far = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let wrong = || format!("a face has the corner {}; expected V, V/VT, V//VN or V/VT/VN", quoted(word));
        let mut corner = [NONE; 3];
        for (k, part) in word.split(|byte| *byte == b'/').enumerate() {
            let slot = corner.get_mut(k).ok_or_else(wrong)?;
            // Faces may name normals or texture coordinates in a file that has none.
            if k > 0 && (part.is_empty() || part.starts_with(b"-") && so_far[k] == 0) {
                continue;
            }
            let index: i64 = std::str::from_utf8(part).ok().and_then(|part| part.parse().ok()).ok_or_else(wrong)?;
            let from_0 =
                if index < 0 { i64::try_from(so_far[k]).unwrap_or(0).checked_add(index) } else { index.checked_sub(1) };
            let index_from_0 = from_0.and_then(|index| u32::try_from(index).ok()).filter(|index| *index != NONE);
            *slot = index_from_0.ok_or_else(|| outside(k, index, so_far[k]))?;
        }
        Ok(corner)
    }

    /// Mesh of all faces; a vertex for each combination of position, texture coordinate and normal.
    fn mesh(self) -> Result<Raw> {
        let mut out = Raw::default();
        let mut vertices = Corners::new();
        let (mut has_uvs, mut has_normals) = (false, false);
        let mut groups = self.groups.iter().peekable();
        let mut first = 0;
        for (k, &(line, end)) in self.faces.iter().enumerate() {
            while groups.next_if(|group| **group <= k).is_some() {
                vertices.forget();
            }
            let corners = &self.corners[first..end];
            first = end;
            let mut polygon = Vec::with_capacity(corners.len());
            for &corner in corners {
                self.check(corner).map_err(|error| format!("line {line}: {error}"))?;
                let [v, vt, vn] = corner.map(|index| index as usize);
                polygon.push(vertices.number(corner, || {
                    let (uv, normal) = (self.uvs.get(vt), self.normals.get(vn));
                    has_uvs |= uv.is_some();
                    has_normals |= normal.is_some();
                    out.positions.push(self.positions[v]);
                    out.uvs.push(uv.copied().unwrap_or(Vec2::NAN));
                    out.normals.push(normal.copied().unwrap_or(Vec3::NAN));
                })?);
            }
            out.add_polygon(&polygon).map_err(|error| format!("line {line}: {error}"))?;
        }
        if !has_uvs {
            out.uvs.clear();
        }
        if !has_normals {
            out.normals.clear();
        }
        out.leave_out(self.small, "faces of fewer than three corners");
        for (what, number) in self.others {
            out.leave_out(number, what);
        }
        Ok(out)
    }

    fn check(&self, corner: Corner) -> Result<()> {
        let counts = [self.positions.len(), self.uvs.len(), self.normals.len()];
        let is_named = |k: usize| corner[k] != NONE && (k == 0 || counts[k] > 0);
        match (0..3).find(|&k| is_named(k) && corner[k] as usize >= counts[k]) {
            Some(k) => Err(outside(k, i64::from(corner[k]) + 1, counts[k])),
            None => Ok(()),
        }
    }
}

/// A corner names something that is not there.
fn outside(part: usize, index: i64, count: usize) -> String {
    let (what, key) = PARTS[part];
    format!("a face names {what} {index}; the file has {count} lines of {key}, counted from 1, or from -1 backwards")
}
