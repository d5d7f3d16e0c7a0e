//! Choice of a technique, and what it draws.

use subsurf_shaders::{BtfLayout, MaterialLayout};

use crate::asset::{BtfMaterial, GpuMesh, GpuPoints, Material, SeparableMaterial, SplatMaterial};

/// Technique by which a mesh is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// Gather: every vertex sums the light of all others within reach. The reference, and slow.
    Gather(MaterialLayout),
    /// Multiresolution splats: every sample that a light sees is spread over what lies around it.
    Splat(MaterialLayout),
    /// Separable blurs on the screen, of L weighted irradiance maps by shared Gaussians; L is 1 or 2.
    Separable(usize),
    /// BTF: light leaves where it enters, as the texture function says; nothing scatters between pixels.
    Btf(BtfLayout),
}

/// Mesh and material on the device, as one technique takes them.
#[derive(Clone, Copy, Debug)]
pub enum Drawable<'a> {
    /// Drawable of [`Technique::Gather`].
    Gather {
        /// Mesh with the point of every vertex, [`crate::VertexData::Points`].
        mesh: &'a GpuMesh,
        /// Points that the vertices name.
        points: &'a GpuPoints,
        /// Material of the mesh.
        material: &'a Material,
    },
    /// Drawable of [`Technique::Splat`].
    Splat {
        /// Mesh with [`crate::VertexData::Ambient`].
        mesh: &'a GpuMesh,
        /// Material of the mesh.
        material: &'a SplatMaterial,
    },
    /// Drawable of [`Technique::Separable`].
    Separable {
        /// Mesh with [`crate::VertexData::Ambient`].
        mesh: &'a GpuMesh,
        /// Material of the mesh.
        material: &'a SeparableMaterial,
    },
    /// Drawable of [`Technique::Btf`].
    Btf {
        /// Mesh with [`crate::VertexData::Tangents`].
        mesh: &'a GpuMesh,
        /// File, or images, of the BTF.
        material: &'a BtfMaterial,
        /// Number of the material in the file, from 0.
        number: usize,
    },
}

impl Drawable<'_> {
    /// Mesh that is drawn.
    pub(crate) fn mesh(&self) -> &GpuMesh {
        match self {
            Self::Gather { mesh, .. }
            | Self::Splat { mesh, .. }
            | Self::Separable { mesh, .. }
            | Self::Btf { mesh, .. } => mesh,
        }
    }
}
