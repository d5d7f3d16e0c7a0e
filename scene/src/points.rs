//! Vertices of a mesh as points that exchange light: area, pixel of the material, and a grid to find neighbours.

use std::borrow::Cow;

use glam::{UVec3, Vec2, Vec3, Vec4};
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader};

use crate::light::MAX_LIGHTS;
use crate::mapping::Mapping;
use crate::mesh::Mesh;

/// Points of a surface, sorted into the cells of a grid; all tables but `cell_starts`, `point_of` and `share_of` have one entry for
/// each point.
///
/// A vertex is one point, or two where box mapping blends two places of the material: what is linear in f = exp(P̂ / 2) of both
/// ends is a sum over them.
#[derive(Clone, Debug)]
pub struct SurfacePoints {
    /// Cells around the surface.
    pub grid: PointGrid,
    /// Positions in mm; in the fourth place, the area in mm² that the point stands for.
    pub positions: Vec<Vec4>,
    /// Unit normals; 0 in the fourth place.
    pub normals: Vec<Vec4>,
    /// Shares of each light that reach the point, 0 to 1.
    pub visibilities: Vec<[f32; MAX_LIGHTS]>,
    /// Column and row of the material's pixel at the point.
    pub pixels: Vec<[u16; 2]>,
    /// Number of the first point of every cell, `[z][y][x]`, and one more entry: the number of points.
    pub cell_starts: Vec<u32>,
    /// Number of the point of every vertex, in the order of the mesh; where there is a second one, it is the next.
    pub point_of: Vec<u32>,
    /// Share of that point in its vertex, 0.5 to 1; the rest is the share of the next point.
    pub share_of: Vec<f32>,
}

/// Grid of cubes around a surface, to find neighbouring points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PointGrid {
    /// Lowest corner, in mm.
    pub origin_mm: Vec3,
    /// Edge of a cell, in mm.
    pub cell_mm: f32,
    /// Cells in x, y and z.
    pub cells: UVec3,
    /// Number of points.
    pub points: u32,
}

/// Most cells to a side: the grid stays small however large the mesh is.
const MAX_CELLS: f32 = 96.0;

impl SurfacePoints {
    /// Points of a mesh that is made of a material. `visibilities` are the shares of each light that reach every vertex, 0 to
    /// 1, as [`crate::visibility`] has them.
    ///
    /// Each vertex stands for a third of the triangles around it, shared by its points. A patch that clamps is mirrored where the mesh is
    /// larger than the patch: its border would be drawn out otherwise.
    ///
    /// # Panics
    /// If `visibilities` is shorter than the mesh.
    #[must_use]
    pub fn new(mesh: &Mesh, mapping: Mapping, header: &BssrdfHeader, visibilities: &[[f32; MAX_LIGHTS]]) -> Self {
        let [low, high] = mesh.bounds();
        let extent = (high - low).max_element();
        // Half the radius of scattering: a row of cells has few points that are too far away.
        let cell_mm = (0.5 * header.r_max_mm).max(extent / MAX_CELLS);
        let cells = ((high - low) / cell_mm).floor().as_uvec3() + 1;
        let cell_of = |position: Vec3| {
            let cell = ((position - low) / cell_mm).floor().as_uvec3().min(cells - 1);
            (cell.z * cells.y + cell.y) * cells.x + cell.x
        };

        // Points by cell, and within a cell in the order of the mesh.
        let vertices = u32::try_from(mesh.positions.len()).expect("meshes have fewer than 2³² vertices");
        let mut order: Vec<u32> = (0..vertices).collect();
        order.sort_by_key(|&vertex| cell_of(mesh.positions[vertex as usize]));
        let pixels_of = pixels_of(mesh, mapping, header);
        let mut cell_starts = vec![0_u32; (cells.x * cells.y * cells.z) as usize + 1];
        let mut point_of = vec![0; mesh.positions.len()];
        let mut share_of = vec![1.0; mesh.positions.len()];
        // Vertex, pixel and share of each point.
        let mut points = Vec::with_capacity(mesh.positions.len());
        for vertex in order.into_iter().map(|vertex| vertex as usize) {
            let (pixels, share) = pixels_of(vertex);
            point_of[vertex] = u32::try_from(points.len()).expect("at most two to a vertex");
            share_of[vertex] = share;
            points.push((vertex, pixels[0], share));
            if share < 1.0 {
                points.push((vertex, pixels[1], 1.0 - share));
            }
            cell_starts[cell_of(mesh.positions[vertex]) as usize + 1] = u32::try_from(points.len()).unwrap_or(u32::MAX);
        }
        // Cells without points begin where the ones before end.
        for cell in 1..cell_starts.len() {
            cell_starts[cell] = cell_starts[cell].max(cell_starts[cell - 1]);
        }

        let areas = mesh.vertex_areas();
        Self {
            grid: PointGrid {
                origin_mm: low,
                cell_mm,
                cells,
                points: u32::try_from(points.len()).expect("at most two to a vertex"),
            },
            positions: points.iter().map(|&(v, _, share)| mesh.positions[v].extend(areas[v] * share)).collect(),
            normals: points.iter().map(|&(v, ..)| mesh.normals[v].extend(0.0)).collect(),
            visibilities: points.iter().map(|&(v, ..)| visibilities[v]).collect(),
            pixels: points.iter().map(|&(_, pixel, _)| pixel).collect(),
            cell_starts,
            point_of,
            share_of,
        }
    }

    /// Values of the vertices from those of the points, in the order of the mesh.
    ///
    /// # Panics
    /// If there are fewer values than points.
    #[must_use]
    pub fn of_vertices(&self, values: &[[f32; 3]]) -> Vec<[f32; 3]> {
        let vertices = self.point_of.iter().zip(&self.share_of);
        let value = |(&point, &share): (&u32, &f32)| {
            let first = values[point as usize];
            if share == 1.0 {
                return first;
            }
            let second = values[point as usize + 1];
            [0, 1, 2].map(|c| share * first[c] + (1.0 - share) * second[c])
        };
        vertices.map(value).collect()
    }

    /// Number of points.
    #[must_use]
    pub fn len(&self) -> usize {
        self.positions.len()
    }

    /// Whether there are no points.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }
}

/// Pixels of the material at a vertex, and the share of the first.
fn pixels_of<'a>(
    mesh: &'a Mesh,
    mapping: Mapping,
    header: &'a BssrdfHeader,
) -> impl Fn(usize) -> ([[u16; 2]; 2], f32) + 'a {
    #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
    let size = Vec2::new(header.width as f32, header.height as f32);
    let addressing = match header.addressing {
        Addressing::Clamp => Addressing::Mirror,
        other => other,
    };
    // Of coordinates in pixels, y down.
    let pixel = move |at: Vec2| {
        #[allow(clippy::cast_possible_truncation, reason = "saturates; meshes are not billions of pixels large")]
        let pixel = [(at.x.floor() as i32, header.width), (at.y.floor() as i32, header.height)];
        pixel.map(|(x, n)| u16::try_from(addressing.map(x, n)).unwrap_or(0))
    };
    let uvs = match mapping {
        Mapping::Uv(copies) => mesh.uvs.as_ref().map(|uvs| (uvs, Vec2::from(copies))),
        Mapping::Box => None,
    };
    let sides = if uvs.is_some() { Cow::default() } else { mesh.sides() };
    move |vertex| {
        if let Some((uvs, copies)) = uvs {
            let uv = uvs[vertex] * copies;
            return ([pixel(Vec2::new(uv.x, 1.0 - uv.y) * size); 2], 1.0);
        }
        let places = sides[vertex].places(mesh.positions[vertex]);
        (places.at_mm.map(|at_mm| pixel(at_mm / header.pitch_mm + 0.5 * size)), places.share)
    }
}
