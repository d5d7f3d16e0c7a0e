//! The vertices of a mesh as points that exchange light: area, pixel of the material, and a grid to find neighbours.

use glam::{Vec2, Vec3, Vec4};
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader};
use subsurf_shaders::cpu::{self, Points};
use subsurf_shaders::uniform::{self, MAX_LIGHTS};

use super::mesh::Mesh;

/// Where on a surface which pixel of the patch lies.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping {
    /// Texture coordinates: the unit square shows the patch this many times in u and in v.
    Uv([f32; 2]),
    /// In its own size, from the side that each normal faces most (box mapping).
    Box,
}

/// Points of a surface, sorted into the cells of a grid.
#[derive(Clone, Debug)]
pub struct Surface {
    pub(crate) grid: uniform::Surface,
    pub(crate) positions: Vec<Vec4>,
    pub(crate) normals: Vec<Vec4>,
    pub(crate) visibilities: Vec<[f32; MAX_LIGHTS]>,
    pub(crate) pixels: Vec<[u16; 2]>,
    pub(crate) cell_starts: Vec<u32>,
    /// The point of every vertex.
    pub(crate) point_of: Vec<u32>,
}

/// Cells to a side, at most: the grid stays small however large the mesh is.
const MAX_CELLS: f32 = 96.0;

impl Surface {
    /// Spreads a material over a mesh. `visibilities` says of every vertex how much of each light reaches it,
    /// 0 to 1.
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
            grid: uniform::Surface { origin_mm: low.into(), cell_mm, cells: cells.into(), points: vertices },
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

    /// Whether there are none.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.positions.is_empty()
    }

    /// Irradiance that enters at every point.
    #[must_use]
    pub fn irradiance(&self, scene: &uniform::Scene) -> Vec<[f32; 3]> {
        cpu::irradiance(scene, &self.positions, &self.normals, &self.visibilities)
    }

    /// The point of every vertex of the mesh.
    #[must_use]
    pub fn point_of(&self) -> &[u32] {
        &self.point_of
    }

    /// How much of each light reaches every point.
    #[must_use]
    pub fn visibilities(&self) -> &[[f32; MAX_LIGHTS]] {
        &self.visibilities
    }

    /// The points as the CPU twin of the pass takes them.
    #[must_use]
    pub fn points(&self) -> Points<'_> {
        Points { surface: self.grid, positions: &self.positions, pixels: &self.pixels, cell_starts: &self.cell_starts }
    }
}

fn pixel_of(mesh: &Mesh, vertex: usize, mapping: Mapping, header: &BssrdfHeader) -> [u16; 2] {
    #[allow(clippy::cast_precision_loss, reason = "sides are below 65,536")]
    let size = Vec2::new(header.width as f32, header.height as f32);
    // Pixels, y down.
    let at = match (mapping, &mesh.uvs) {
        (Mapping::Uv(times), Some(uvs)) => {
            let uv = uvs[vertex] * Vec2::from(times);
            Vec2::new(uv.x, 1.0 - uv.y) * size
        }
        _ => {
            cpu::place_in_box(mesh.positions[vertex], mesh.normals[vertex], header.pitch_mm) / header.pitch_mm
                + 0.5 * size
        }
    };
    let addressing = match header.addressing {
        Addressing::Clamp => Addressing::Mirror,
        other => other,
    };
    #[allow(clippy::cast_possible_truncation, reason = "saturates; meshes are not billions of pixels large")]
    let pixel = [(at.x.floor() as i32, header.width), (at.y.floor() as i32, header.height)];
    pixel.map(|(x, n)| u16::try_from(addressing.map(x, n)).unwrap_or(0))
}
