//! Meshes from STL, in text or binary. Corners at the same place are one vertex, so that round things are round.

use glam::{DVec3, Vec3};

use super::corners::Corners;
use super::raw::{Raw, Result};
use super::text::{Lines, numbers, without_mark, words};

/// Bytes before the triangles of a binary file: any text, and their number.
const HEADER: usize = 84;
/// Bytes of a triangle: its normal, its corners, and two of no meaning.
const TRIANGLE: usize = 50;

/// Reads the bytes of an .stl file.
pub(super) fn read(bytes: &[u8]) -> Result<Raw> {
    let text = without_mark(bytes);
    let is_solid = text.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let mut out = Facets { mesh: Raw::default(), vertices: Corners::new(), small: 0 };
    // Binary files may begin with this word as well; their size tells.
    match facets(bytes) {
        Err(_) if is_solid => in_text(&text, &mut out)?,
        Err(error) => return Err(error),
        Ok(facets) => {
            let corner = |numbers: &[u8; 12]| {
                Vec3::from([0, 4, 8].map(|at| f32::from_le_bytes([0, 1, 2, 3].map(|k| numbers[at + k])))).as_dvec3()
            };
            let behind = (bytes.len() - HEADER) / TRIANGLE - facets.len();
            out.mesh.leave_out(behind, "facets behind those that the header counts");
            for facet in facets {
                let corners: Vec<DVec3> = facet[12..48].as_chunks().0.iter().map(corner).collect();
                out.add(&corners)?;
            }
        }
    }
    out.mesh.leave_out(out.small, "facets of fewer than three corners");
    Ok(out.mesh)
}

/// Facets so far.
struct Facets {
    mesh: Raw,
    vertices: Corners<[u64; 3]>,
    small: usize,
}

impl Facets {
    fn add(&mut self, facet: &[DVec3]) -> Result<()> {
        self.small += usize::from(facet.len() < 3);
        let mut corners = Vec::with_capacity(facet.len());
        for &position in facet {
            // Both zeros are one place.
            let place = (position + 0.0).to_array().map(f64::to_bits);
            corners.push(self.vertices.number(place, || self.mesh.positions.push(position))?);
        }
        self.mesh.add_polygon(&corners)
    }
}

/// Facets of a binary file.
fn facets(bytes: &[u8]) -> Result<&[[u8; TRIANGLE]]> {
    let Some((header, rest)) = bytes.split_at_checked(HEADER) else {
        return Err(format!("{} bytes; a binary STL file has a header of {HEADER}", bytes.len()));
    };
    let count = header.last_chunk().map_or(0, |number| u32::from_le_bytes(*number));
    let all = rest.as_chunks().0;
    all.get(..count as usize).ok_or_else(|| {
        format!("{count} triangles of {TRIANGLE} bytes in the header, but {} bytes after it", rest.len())
    })
}

fn in_text(text: &[u8], out: &mut Facets) -> Result<()> {
    // Corners since the last `outer loop`.
    let mut facet: Option<Vec<DVec3>> = None;
    for (line, words) in Lines::new(text).map(|(number, line)| (number, words(line))) {
        let mut words = words.peekable();
        // Some write several of these on a line.
        while let Some(word) = words.next() {
            match word.to_ascii_lowercase().as_slice() {
                b"solid" | b"endsolid" => break,
                b"loop" => facet = Some(Vec::new()),
                b"endloop" => out.add(&facet.take().unwrap_or_default())?,
                b"vertex" => {
                    let corner = numbers(&mut words).map_err(|error| format!("line {line}: {error}"))?;
                    let corner = corner.ok_or_else(|| format!("line {line}: a vertex of fewer than three numbers"))?;
                    let facet = facet.as_mut();
                    facet
                        .ok_or_else(|| format!("line {line}: a vertex outside of outer loop and endloop"))?
                        .push(corner.into());
                }
                _ => {}
            }
        }
    }
    match facet {
        Some(_) => Err("ends within a facet; expected endloop".to_owned()),
        None => Ok(()),
    }
}
