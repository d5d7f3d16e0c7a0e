//! Where a mesh is and how a material lies on it.

use subsurf_decoder::bssrdf::BssrdfHeader;

use crate::mapping::Mapping;
use crate::mesh::{BoundingSphere, Mesh};

/// Placement of a material on a mesh: all that pictures need to know of both besides their tables.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Where the mesh is.
    pub bounds: BoundingSphere,
    /// Where which pixel of the material lies on the mesh.
    pub mapping: Mapping,
    /// Pixels of the patch, width and height.
    pub size: [u32; 2],
    /// Distance of neighbouring pixels of the patch, in mm.
    pub pitch_mm: f32,
    /// Distance beyond which no light scatters, in mm.
    pub r_max_mm: f32,
    /// Refractive index against air.
    pub eta: f32,
}

impl Placement {
    /// Placement of a scattering material, of which `header` says the size.
    #[must_use]
    pub fn new(mesh: &Mesh, mapping: Mapping, header: &BssrdfHeader) -> Self {
        Self::within(mesh.bounding_sphere(), mapping, header)
    }

    /// The same for a mesh that lies within a sphere.
    #[must_use]
    pub fn within(bounds: BoundingSphere, mapping: Mapping, header: &BssrdfHeader) -> Self {
        Self {
            bounds,
            mapping,
            size: [header.width, header.height],
            pitch_mm: header.pitch_mm,
            r_max_mm: header.r_max_mm,
            eta: header.eta,
        }
    }

    /// Placement of a BTF, which has no size of its own and lets no light in: `copies` of it to the unit square of texture
    /// coordinates, in u and in v.
    #[must_use]
    pub fn of_btf(mesh: &Mesh, copies: [f32; 2]) -> Self {
        Self::of_btf_within(mesh.bounding_sphere(), Mapping::Uv(copies))
    }

    /// The same for a mesh that lies within a sphere.
    #[must_use]
    pub fn of_btf_within(bounds: BoundingSphere, mapping: Mapping) -> Self {
        Self { bounds, mapping, size: [1, 1], pitch_mm: 1.0, r_max_mm: 1.0, eta: 1.0 }
    }

    /// Where a homogeneous material of refractive index `eta` lies on a mesh within a sphere: it is the same everywhere.
    #[must_use]
    pub fn of_homogeneous_within(bounds: BoundingSphere, eta: f32) -> Self {
        Self { eta, ..Self::of_btf_within(bounds, Mapping::Box) }
    }
}
