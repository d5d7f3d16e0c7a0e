//! Vertices of a mesh as points that exchange light: area, pixel of the material, and a grid to find neighbours.

use glam::{UVec3, Vec2, Vec3, Vec4};
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader};

use crate::light::MAX_LIGHTS;
use crate::mapping::{Mapping, place_in_box};
use crate::mesh::Mesh;

/// Points of a surface, sorted into the cells of a grid; all tables but `cell_starts` and `point_of` have one entry for each point.
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
    /// Number of the point of every vertex, in the order of the mesh.
    pub point_of: Vec<u32>,
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
    /// Each vertex stands for a third of the triangles around it. A patch that clamps is mirrored where the mesh is
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
        let mut cell_starts = vec![0_u32; (cells.x * cells.y * cells.z) as usize + 1];
        for position in &mesh.positions {
            cell_starts[cell_of(*position) as usize + 1] += 1;
        }
        for cell in 1..cell_starts.len() {
            cell_starts[cell] += cell_starts[cell - 1];
        }
        let mut point_of = vec![0; mesh.positions.len()];
        for (&vertex, point) in order.iter().zip(0..) {
            point_of[vertex as usize] = point;
        }

        let areas = mesh.vertex_areas();
        let by_point = || order.iter().map(|&vertex| vertex as usize);
        Self {
            grid: PointGrid { origin_mm: low, cell_mm, cells, points: vertices },
            positions: by_point().map(|v| mesh.positions[v].extend(areas[v])).collect(),
            normals: by_point().map(|v| mesh.normals[v].extend(0.0)).collect(),
            visibilities: by_point().map(|v| visibilities[v]).collect(),
            pixels: by_point().map(|v| pixel_of(mesh, v, mapping, header)).collect(),
            cell_starts,
            point_of,
        }
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

/// Pixel of the material at a vertex.
fn pixel_of(mesh: &Mesh, vertex: usize, mapping: Mapping, header: &BssrdfHeader) -> [u16; 2] {
    #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
    let size = Vec2::new(header.width as f32, header.height as f32);
    // Pixels, y down.
    let at = match (mapping, &mesh.uvs) {
        (Mapping::Uv(times), Some(uvs)) => {
            let uv = uvs[vertex] * Vec2::from(times);
            Vec2::new(uv.x, 1.0 - uv.y) * size
        }
        _ => place_in_box(mesh.positions[vertex], mesh.normals[vertex], header.pitch_mm) / header.pitch_mm + 0.5 * size,
    };
    let addressing = match header.addressing {
        Addressing::Clamp => Addressing::Mirror,
        other => other,
    };
    #[allow(clippy::cast_possible_truncation, reason = "saturates; meshes are not billions of pixels large")]
    let pixel = [(at.x.floor() as i32, header.width), (at.y.floor() as i32, header.height)];
    pixel.map(|(x, n)| u16::try_from(addressing.map(x, n)).unwrap_or(0))
}
