//! Material and mesh on a device.

use subsurf_runtime::{
    BtfMaterial, Drawable, Gpu, GpuMesh, GpuPoints, Material, SeparableMaterial, SplatMaterial, Technique, VertexData,
};
use subsurf_scene::{Mesh, Placement};

use crate::error::Result;

/// Material and mesh on a device, as a technique reads them.
#[allow(clippy::large_enum_variant, reason = "one or two at a time, and they stay where they are")]
pub enum GpuAsset {
    /// Points of the surface that exchange light: the reference.
    Gather {
        /// Fine mesh, a point to a vertex.
        mesh: GpuMesh,
        /// Points, and which of them exchange light.
        points: GpuPoints,
        /// Tables of the profiles and of what mixes them, as they stand in the file.
        material: Material,
    },
    /// Light spread over what lies around where it enters.
    Splat {
        /// Mesh, with ambient transfer at every vertex.
        mesh: GpuMesh,
        /// Planes of the file, and the basis whose Gaussians are splatted.
        material: SplatMaterial,
    },
    /// Weighted irradiance maps, blurred by shared Gaussians.
    Separable {
        /// Mesh, with ambient transfer at every vertex.
        mesh: GpuMesh,
        /// Weights of the basis for every pixel, and its Gaussians.
        material: SeparableMaterial,
    },
    /// A bidirectional texture function.
    Btf {
        /// Mesh, with tangents.
        mesh: GpuMesh,
        /// Nested codebooks as they stand in the file, or uncompressed images.
        material: BtfMaterial,
        /// Number of the material in its file.
        number: usize,
    },
}

impl GpuAsset {
    /// Brings a mesh to a device, beside a BTF that is there; `repeats` copies of it lie along u and v.
    ///
    /// # Errors
    /// The mesh has no texture coordinates, or the device no room for it.
    pub fn btf(gpu: &Gpu, mesh: &Mesh, repeats: [f32; 2], material: BtfMaterial, number: usize) -> Result<Self> {
        let tangents = mesh.tangents()?;
        let mesh = GpuMesh::upload(gpu, mesh, &Placement::of_btf(mesh, repeats), VertexData::Tangents(&tangents))?;
        Ok(Self::Btf { mesh, material, number })
    }

    /// Bytes of the mesh on the device.
    #[must_use]
    pub fn mesh_bytes(&self) -> u64 {
        match self {
            Self::Gather { mesh, .. }
            | Self::Splat { mesh, .. }
            | Self::Separable { mesh, .. }
            | Self::Btf { mesh, .. } => mesh.gpu_bytes(),
        }
    }

    /// Bytes of the material on the device.
    #[must_use]
    pub fn material_bytes(&self) -> u64 {
        match self {
            Self::Gather { material, .. } => material.gpu_bytes(),
            Self::Splat { material, .. } => material.planes().gpu_bytes(),
            Self::Separable { material, .. } => material.gpu_bytes(),
            Self::Btf { material, .. } => material.gpu_bytes(),
        }
    }

    /// Mesh and material as the renderer draws them.
    #[must_use]
    pub fn drawable(&self) -> Drawable<'_> {
        match self {
            Self::Gather { mesh, points, material } => Drawable::Gather { mesh, points, material },
            Self::Splat { mesh, material } => Drawable::Splat { mesh, material },
            Self::Separable { mesh, material } => Drawable::Separable { mesh, material },
            Self::Btf { mesh, material, number } => Drawable::Btf { mesh, material, number: *number },
        }
    }

    /// Technique by which the renderer draws it.
    #[must_use]
    pub fn technique(&self) -> Technique {
        match self {
            Self::Gather { material, .. } => Technique::Gather(material.layout()),
            Self::Splat { material, .. } => Technique::Splat(material.planes().layout()),
            Self::Separable { material, .. } => Technique::Separable(material.terms()),
            Self::Btf { material, .. } => Technique::Btf(material.layout()),
        }
    }
}
