//! What is drawn, and by which path.

use subsurf_shaders::{BtfStorage, Storage};

use crate::asset::{BtfMaterial, GpuMesh, GpuPoints, Material, SeparableMaterial, SplatMaterial};

/// How light scatters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// Every vertex gathers from all others within reach: the reference, and slow.
    Gather(Storage),
    /// Multiresolution splatting: every sample that a light sees is spread over what lies around it.
    Splat(Storage),
    /// Weighted irradiance maps on the screen, blurred by shared Gaussians; of so many terms.
    Separable(usize),
    /// None: a BTF says what leaves where light enters.
    Btf(BtfStorage),
}

/// What is drawn: a mesh, and its material as the path wants it.
#[derive(Clone, Copy, Debug)]
pub enum Drawable<'a> {
    /// For [`Technique::Gather`].
    Gather {
        /// The mesh, with the point of every vertex.
        mesh: &'a GpuMesh,
        /// Its points.
        points: &'a GpuPoints,
        /// Its material.
        material: &'a Material,
    },
    /// For [`Technique::Splat`].
    Splat {
        /// The mesh.
        mesh: &'a GpuMesh,
        /// Its material.
        material: &'a SplatMaterial,
    },
    /// For [`Technique::Separable`].
    Separable {
        /// The mesh.
        mesh: &'a GpuMesh,
        /// Its material.
        material: &'a SeparableMaterial,
    },
    /// For [`Technique::Btf`].
    Btf {
        /// The mesh, with tangents.
        mesh: &'a GpuMesh,
        /// The file, or images.
        material: &'a BtfMaterial,
        /// Which of the file's materials, from 0.
        number: usize,
    },
}

impl Drawable<'_> {
    pub(crate) fn mesh(&self) -> &GpuMesh {
        match self {
            Self::Gather { mesh, .. }
            | Self::Splat { mesh, .. }
            | Self::Separable { mesh, .. }
            | Self::Btf { mesh, .. } => mesh,
        }
    }
}
