//! Materials as renderers take them: what is on the device, and the technique that draws it.

use std::sync::Arc;

use subsurf_scene::{Mapping, Placement};

use super::bssrdf::BssrdfPlanes;
use super::btf::BtfMaterial;
use super::kernel::KernelMaterial;
#[cfg(feature = "reference")]
use super::linsss::LinsssMaterial;
use super::mesh::GpuMesh;
use super::points::GpuPoints;
use super::separable::SeparableMaterial;
use super::splat::SplatMaterial;
#[cfg(feature = "transfer")]
use super::transfer::TransferMaterial;
use crate::error::{Error, Result};
use crate::technique::Technique;

/// Material for the gather on the device: planes of its file, and the points of the one mesh that it lies on.
#[derive(Debug)]
pub struct GatherMaterial {
    /// Planes of the file.
    pub planes: BssrdfPlanes,
    /// Points of the surface, between which light scatters.
    pub points: GpuPoints,
}

/// Material on the device, as its technique takes it. Clones share what is on the device.
#[derive(Clone, Debug)]
pub enum Material {
    /// Material for the reference sum between the points of one mesh.
    Gather(Arc<GatherMaterial>),
    /// Material for multiresolution splats.
    Splat(Arc<SplatMaterial>),
    /// Material for separable blurs on the screen.
    Separable(Arc<SeparableMaterial>),
    /// Material of LinSSS, a rival.
    #[cfg(feature = "reference")]
    Linsss(Arc<LinsssMaterial>),
    /// One material of a BTF, by its number in the file from 0 on.
    Btf(Arc<BtfMaterial>, usize),
    /// Homogeneous material for its separable kernel on the screen.
    Kernel(Arc<KernelMaterial>),
    /// Homogeneous material with the scattering that is precomputed for one mesh.
    #[cfg(feature = "transfer")]
    Transfer(Arc<TransferMaterial>),
}

impl Material {
    /// Technique that draws the material.
    #[must_use]
    pub fn technique(&self) -> Technique {
        match self {
            Self::Gather(material) => Technique::Gather(material.planes.layout()),
            Self::Splat(material) => Technique::Splat(material.planes.layout()),
            Self::Separable(material) => Technique::Separable(material.terms()),
            #[cfg(feature = "reference")]
            Self::Linsss(_) => Technique::Linsss,
            Self::Btf(material, _) => Technique::Btf(material.layout()),
            Self::Kernel(_) => Technique::Kernel,
            #[cfg(feature = "transfer")]
            Self::Transfer(_) => Technique::Transfer,
        }
    }

    /// Bytes of the material on the device, without those of points.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        match self {
            Self::Gather(material) => material.planes.gpu_bytes(),
            Self::Splat(material) => material.gpu_bytes(),
            Self::Separable(material) => material.gpu_bytes(),
            #[cfg(feature = "reference")]
            Self::Linsss(material) => material.gpu_bytes(),
            Self::Btf(material, _) => material.gpu_bytes(),
            Self::Kernel(material) => material.gpu_bytes(),
            #[cfg(feature = "transfer")]
            Self::Transfer(material) => material.gpu_bytes(),
        }
    }

    /// Whether both are the same material on the device.
    pub(crate) fn is(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Gather(a), Self::Gather(b)) => Arc::ptr_eq(a, b),
            (Self::Splat(a), Self::Splat(b)) => Arc::ptr_eq(a, b),
            (Self::Separable(a), Self::Separable(b)) => Arc::ptr_eq(a, b),
            #[cfg(feature = "reference")]
            (Self::Linsss(a), Self::Linsss(b)) => Arc::ptr_eq(a, b),
            (Self::Btf(a, k), Self::Btf(b, l)) => Arc::ptr_eq(a, b) && k == l,
            (Self::Kernel(a), Self::Kernel(b)) => Arc::ptr_eq(a, b),
            #[cfg(feature = "transfer")]
            (Self::Transfer(a), Self::Transfer(b)) => Arc::ptr_eq(a, b),
            _ => false,
        }
    }

    /// Whether light is summed for the vertices of one object.
    pub(crate) fn is_of_one_object(&self) -> bool {
        match self {
            Self::Gather(_) => true,
            #[cfg(feature = "transfer")]
            Self::Transfer(_) => true,
            _ => false,
        }
    }

    /// Where the material lies on a mesh.
    ///
    /// # Errors
    /// [`Error::Mesh`] or [`Error::Usage`] if the mesh lacks what the material needs.
    pub(crate) fn placement(&self, mesh: &GpuMesh, mapping: Mapping) -> Result<Placement> {
        let header = match self {
            // What is the same everywhere is looked up nowhere.
            Self::Kernel(material) => {
                return Ok(Placement::of_homogeneous_within(mesh.bounds, material.header().eta));
            }
            #[cfg(feature = "transfer")]
            Self::Transfer(material) => {
                material.expect(mesh)?;
                return Ok(Placement::of_homogeneous_within(mesh.bounds, material.header().eta));
            }
            Self::Gather(material) => {
                material.points.expect(mesh)?;
                material.planes.header()
            }
            Self::Splat(material) => material.planes.header(),
            Self::Separable(material) => material.header(),
            #[cfg(feature = "reference")]
            Self::Linsss(material) => material.header(),
            Self::Btf(..) => {
                if let Mapping::Uv(_) = mapping {
                    mesh.expect_uvs()?;
                }
                mesh.expect_tangents()?;
                if mapping == Mapping::Box {
                    return Err(Error::Usage("BTFs lie on meshes by texture coordinates, not by a box".to_owned()));
                }
                return Ok(Placement::of_btf_within(mesh.bounds, mapping));
            }
        };
        if let Mapping::Uv(_) = mapping {
            mesh.expect_uvs()?;
        }
        Ok(Placement::within(mesh.bounds, mapping, header))
    }
}

impl From<GatherMaterial> for Material {
    fn from(material: GatherMaterial) -> Self {
        Self::Gather(Arc::new(material))
    }
}

impl From<Arc<SplatMaterial>> for Material {
    fn from(material: Arc<SplatMaterial>) -> Self {
        Self::Splat(material)
    }
}

impl From<Arc<SeparableMaterial>> for Material {
    fn from(material: Arc<SeparableMaterial>) -> Self {
        Self::Separable(material)
    }
}

impl From<Arc<KernelMaterial>> for Material {
    fn from(material: Arc<KernelMaterial>) -> Self {
        Self::Kernel(material)
    }
}

#[cfg(feature = "transfer")]
impl From<Arc<TransferMaterial>> for Material {
    fn from(material: Arc<TransferMaterial>) -> Self {
        Self::Transfer(material)
    }
}
