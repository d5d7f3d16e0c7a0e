//! Where a mesh is and how a material lies on it.

use glam::Vec3;
use subsurf_decoder::bssrdf::{Addressing, Coding, Header};

use crate::mapping::Mapping;
use crate::mesh::Mesh;

/// What is known of a mesh and its material besides their tables.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    /// Middle of the mesh, in mm.
    pub centre_mm: Vec3,
    /// Radius of a sphere around it that holds the mesh, in mm.
    pub radius_mm: f32,
    /// Pitch, refractive index and so on of the material.
    pub header: Header,
    /// Where the material lies on the mesh.
    pub mapping: Mapping,
}

impl Outline {
    /// Of a mesh made of a material.
    #[must_use]
    pub fn new(mesh: &Mesh, mapping: Mapping, header: &Header) -> Self {
        let [low, high] = mesh.bounds();
        let centre_mm = 0.5 * (low + high);
        let radius_mm = mesh.positions.iter().map(|position| position.distance(centre_mm)).fold(1e-3, f32::max);
        Self { centre_mm, radius_mm, header: *header, mapping }
    }

    /// Of a mesh made of a BTF, which has no size of its own and lets no light in: copies of it to the unit square of
    /// texture coordinates, in u and in v.
    #[must_use]
    pub fn of_btf(mesh: &Mesh, copies: [f32; 2]) -> Self {
        let nothing = Header {
            model: 0,
            coding: Coding::Exact,
            addressing: Addressing::Repeat,
            width: 1,
            height: 1,
            window_radius: 1,
            samples: 2,
            base_materials: 1,
            pitch_mm: 1.0,
            r_max_mm: 1.0,
            eta: 1.0,
        };
        Self::new(mesh, Mapping::Uv(copies), &nothing)
    }
}
