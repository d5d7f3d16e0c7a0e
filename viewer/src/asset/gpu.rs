//! Material and mesh on a device.

use subsurf_decoder::{Kernel, Transfer};
use subsurf_runtime::{BtfMaterial, Gpu, GpuMesh, Load, Material, Object, Technique, VertexData};
use subsurf_scene::{AmbientTransfer, Mapping, Mesh};

use crate::error::Result;

/// Material and mesh on a device, and how one lies on the other.
pub struct GpuAsset {
    /// Mesh, with what the technique needs of its vertices.
    pub mesh: GpuMesh,
    /// Material, which says by which technique it is drawn.
    pub material: Material,
    /// Rule by which the material lies on the mesh.
    pub mapping: Mapping,
}

impl GpuAsset {
    /// Brings a mesh to a device, beside a BTF that is there; `repeats` copies of it lie along u and v.
    ///
    /// # Errors
    /// The mesh has no texture coordinates, the device no room for it, or the BTF no such material.
    pub fn btf(gpu: &Gpu, mesh: &Mesh, repeats: [f32; 2], material: BtfMaterial, number: usize) -> Result<Self> {
        let tangents = mesh.tangents()?;
        let known = VertexData { tangents: Some(&tangents), ..Default::default() };
        Ok(Self {
            mesh: GpuMesh::upload(gpu, mesh, known)?,
            material: Material::Btf(material.into(), number),
            mapping: Mapping::Uv(repeats),
        })
    }

    /// Brings a mesh to a device that is made of a homogeneous material; `ambient` is of every vertex.
    ///
    /// # Errors
    /// The device has no room for it.
    pub fn kernel(gpu: &Gpu, mesh: &Mesh, kernel: &Kernel<'_>, ambient: &[AmbientTransfer]) -> Result<Self> {
        let known = VertexData { ambient: Some(ambient), ..Default::default() };
        Ok(Self {
            mesh: GpuMesh::upload(gpu, mesh, known)?,
            material: Load::kernel(gpu, kernel)?.finish()?.into(),
            mapping: Mapping::Box,
        })
    }

    /// Brings a mesh to a device, beside what is precomputed for its vertices; of another mesh it is not drawn.
    ///
    /// # Errors
    /// The device has no room for it, or the file is unfit.
    pub fn transfer(gpu: &Gpu, mesh: &Mesh, transfer: &Transfer<'_>) -> Result<Self> {
        Ok(Self {
            mesh: GpuMesh::upload(gpu, mesh, VertexData::default())?,
            material: Load::transfer(gpu, transfer)?.finish()?.into(),
            mapping: Mapping::Box,
        })
    }

    /// Bytes of the mesh on the device.
    #[must_use]
    pub fn mesh_bytes(&self) -> u64 {
        self.mesh.gpu_bytes()
    }

    /// Bytes of the material on the device.
    #[must_use]
    pub fn material_bytes(&self) -> u64 {
        self.material.gpu_bytes()
    }

    /// Object that the renderer draws, under a coat of that roughness.
    #[must_use]
    pub fn object(&self, roughness: f32) -> Object<'_> {
        Object::new(&self.mesh, &self.material, self.mapping, roughness)
    }

    /// Technique by which the renderer draws it.
    #[must_use]
    pub fn technique(&self) -> Technique {
        self.material.technique()
    }
}
