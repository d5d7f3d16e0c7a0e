//! The surface of a mesh as points that send and receive light.

use std::collections::HashMap;

use glam::Vec3;
use subsurf_scene::Mesh;

/// Distance below which vertices are in one place, by the longest side of the mesh: ends of curves that close are apart by rounding, and
/// what one of them lets in would leave at the other as if through a hole.
const SAME: f32 = 2e-6;
/// Edge of the cells in which places are looked up, by that distance.
const CELL: f32 = 64.0;

/// Places of a mesh's vertices. Vertices of one place, which meshes have at seams, send together and receive the same.
pub(super) struct Surface {
    /// Place of each vertex, by its number.
    pub(super) place_of: Vec<u32>,
    /// Places in mm, in the order of their first vertices.
    pub(super) positions: Vec<Vec3>,
    /// Areas in mm² that the places stand for: thirds of the triangles around.
    pub(super) areas: Vec<f32>,
    /// Vertices `[place]` with their areas in mm², those without area left out.
    pub(super) senders: Vec<Vec<(u32, f32)>>,
    /// Places of the corners of the triangles.
    pub(super) triangles: Vec<[u32; 3]>,
}

impl Surface {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let areas = mesh.vertex_areas();
        // Vertices without a triangle may be anywhere.
        let of_surface = mesh.positions.iter().zip(&areas).filter(|(_, area)| **area > 0.0);
        let bounds = of_surface.map(|(at, _)| [*at; 2]).reduce(|[low, high], [at, _]| [low.min(at), high.max(at)]);
        let [low, high] = bounds.unwrap_or_else(|| mesh.bounds());
        let same_mm = SAME * (high - low).max_element();
        let mut cells: HashMap<[i32; 3], Vec<u32>> = HashMap::with_capacity(mesh.positions.len());
        let mut out = Self {
            place_of: Vec::new(),
            positions: Vec::new(),
            areas: Vec::new(),
            senders: Vec::new(),
            triangles: Vec::new(),
        };
        for ((vertex, position), area) in (0..).zip(&mesh.positions).zip(areas) {
            let next = u32::try_from(out.positions.len()).expect("fewer than 2³² vertices");
            let corner = |step: f32| ((*position - low + step) / (CELL * same_mm)).floor().as_ivec3();
            let (first, last) = (corner(-same_mm), corner(same_mm));
            let around = (first.x..=last.x)
                .flat_map(|x| (first.y..=last.y).flat_map(move |y| (first.z..=last.z).map(move |z| [x, y, z])));
            let mut known = around.filter_map(|cell| cells.get(&cell)).flatten();
            let number = known.find(|place| out.positions[**place as usize].distance(*position) <= same_mm);
            let number = number.copied().unwrap_or(next);
            if number == next {
                cells.entry(corner(0.0).to_array()).or_default().push(next);
                out.positions.push(*position);
                out.areas.push(0.0);
                out.senders.push(Vec::new());
            }
            out.place_of.push(number);
            let place = number as usize;
            out.areas[place] += area;
            if area > 0.0 {
                out.senders[place].push((vertex, area));
            }
        }
        let places = |triangle: &[u32; 3]| triangle.map(|vertex| out.place_of[vertex as usize]);
        out.triangles = mesh.triangles.iter().map(places).collect();
        out
    }

    /// Places.
    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    /// Share of the area, 0 to 1, where neighbours are farther apart than `spacing_mm`: the side of a square of a place's area.
    pub(super) fn coarser_than(&self, spacing_mm: f32) -> f32 {
        let coarse: f32 = self.areas.iter().filter(|area| area.sqrt() > spacing_mm).sum();
        coarse / self.areas.iter().sum::<f32>()
    }
}
