//! The surface of a mesh as points that send and receive light.

use std::collections::HashMap;

use glam::Vec3;
use subsurf_scene::Mesh;

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
}

impl Surface {
    pub(super) fn new(mesh: &Mesh) -> Self {
        let mut numbers: HashMap<[u32; 3], u32> = HashMap::with_capacity(mesh.positions.len());
        let mut out = Self { place_of: Vec::new(), positions: Vec::new(), areas: Vec::new(), senders: Vec::new() };
        for ((vertex, position), area) in (0..).zip(&mesh.positions).zip(mesh.vertex_areas()) {
            // 0 and −0 are one place.
            let key = (*position + Vec3::ZERO).to_array().map(f32::to_bits);
            let next = u32::try_from(out.positions.len()).expect("fewer than 2³² vertices");
            let number = *numbers.entry(key).or_insert(next);
            if number == next {
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
        out
    }

    /// Places.
    pub(super) fn len(&self) -> usize {
        self.positions.len()
    }

    /// Mean distance between neighbours in mm: the side of a square of the mean area.
    pub(super) fn spacing_mm(&self) -> f32 {
        (self.areas.iter().sum::<f32>() / self.len() as f32).sqrt()
    }
}
