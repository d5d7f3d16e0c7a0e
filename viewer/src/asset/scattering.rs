//! What a technique needs of a translucent material and a mesh, computed without a device.

use std::sync::Arc;

use subsurf_decoder::Bssrdf;
use subsurf_runtime::{BssrdfPlanes, GatherMaterial, Gpu, GpuMesh, GpuPoints, Load, Material, VertexData};
use subsurf_scene::{AmbientTransfer, Mapping, Mesh, Scene, SurfacePoints, visibility};
use subsurf_shaders::separable::{BasisNumbers, ProjectedBasis};

use super::gpu::GpuAsset;
use crate::error::{Error, Result};

/// Longest edge of the mesh between whose vertices light is gathered, in pixels of the material.
const LONGEST_EDGE: f32 = 1.5;

/// Technique by which a translucent material is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scattering {
    /// Every point gathers light from all others within reach: the reference.
    Gather,
    /// Every place that the light reaches is spread over what lies around it.
    Splat,
    /// Weighted irradiance maps and shared Gaussians: many times faster, and an approximation.
    Separable,
    /// The same with one mean profile everywhere, as if the material were not heterogeneous; for comparison.
    Homogeneous,
    /// Light leaves where it enters, as much of it as of the translucent material; for comparison.
    Opaque,
}

/// Translucent material and mesh as a technique needs them: what takes long to compute, and needs no device.
pub struct Asset {
    mapping: Mapping,
    parts: Parts,
}

enum Parts {
    Gather {
        fine: Mesh,
        surface: SurfacePoints,
    },
    Splat {
        sky: Arc<Vec<AmbientTransfer>>,
    },
    /// Without light from all around, each vertex is lit as open, flat ground is.
    Separable {
        sky: Option<Arc<Vec<AmbientTransfer>>>,
        numbers: BasisNumbers,
    },
}

impl Asset {
    /// Computes what `technique` needs; the lights of the scene count for gathers only.
    ///
    /// `sky`, where it is known already for this mesh and material, is not computed again.
    ///
    /// # Errors
    /// The mesh is broken, or too fine a one would be needed; the file has no separable basis, and the technique needs one.
    pub fn compute(
        material: &Bssrdf<'_>,
        mesh: &Mesh,
        mapping: Mapping,
        scene: &Scene,
        technique: Scattering,
        sky: Option<Arc<Vec<AmbientTransfer>>>,
    ) -> Result<Self> {
        let sky = || match sky {
            Some(sky) => Ok(sky),
            None => AmbientTransfer::of(mesh, material).map(Arc::new),
        };
        let parts = match technique {
            Scattering::Gather => {
                let (fine, surface) = points(mesh, mapping, material, scene)?;
                Parts::Gather { fine, surface }
            }
            Scattering::Splat => Parts::Splat { sky: sky()? },
            Scattering::Separable | Scattering::Homogeneous => {
                Parts::Separable { numbers: numbers(material, technique)?, sky: Some(sky()?) }
            }
            Scattering::Opaque => Parts::Separable { numbers: numbers(material, technique)?, sky: None },
        };
        Ok(Self { mapping, parts })
    }

    /// Light from all around at every vertex, the same for all techniques that want it; none for gathers.
    #[must_use]
    pub fn sky(&self) -> Option<&Arc<Vec<AmbientTransfer>>> {
        match &self.parts {
            Parts::Splat { sky } => Some(sky),
            Parts::Separable { sky, .. } => sky.as_ref(),
            Parts::Gather { .. } => None,
        }
    }

    /// Brings everything to a device; material and mesh have to be those that it was computed for.
    ///
    /// # Errors
    /// The device cannot draw it, or has no room for it.
    pub fn upload(&self, gpu: &Gpu, material: &Bssrdf<'_>, mesh: &Mesh) -> Result<GpuAsset> {
        let shared = |ambient: Option<&[AmbientTransfer]>| {
            GpuMesh::upload(gpu, mesh, VertexData { ambient, ..Default::default() })
        };
        let (mesh, material): (_, Material) = match &self.parts {
            Parts::Gather { fine, surface } => {
                let known = VertexData { points: Some(&surface.point_of), ..Default::default() };
                let planes = BssrdfPlanes::upload(gpu, material)?;
                let material = GatherMaterial { planes, points: GpuPoints::upload(gpu, surface)? };
                (GpuMesh::upload(gpu, fine, known)?, material.into())
            }
            Parts::Splat { sky } => (shared(Some(sky))?, Load::splat(gpu, material)?.finish()?.into()),
            Parts::Separable { sky, numbers } => (
                shared(sky.as_ref().map(|sky| sky.as_slice()))?,
                Load::separable(gpu, material, numbers)?.finish()?.into(),
            ),
        };
        Ok(GpuAsset { mesh, material, mapping: self.mapping })
    }
}

/// Separable basis of a file with the coefficients of every pixel, or what [`Scattering::Homogeneous`] and
/// [`Scattering::Opaque`] have instead.
///
/// # Errors
/// The file has no basis.
pub fn basis(material: &Bssrdf<'_>, technique: Scattering) -> Result<ProjectedBasis> {
    let basis = ProjectedBasis::of(material).ok_or_else(no_basis)?;
    Ok(match technique {
        Scattering::Homogeneous => basis.homogeneous(),
        Scattering::Opaque => basis.opaque(),
        _ => basis,
    })
}

/// Numbers of the separable basis of a file, or of what [`Scattering::Homogeneous`] and [`Scattering::Opaque`] have instead.
///
/// # Errors
/// The file has no basis.
pub fn numbers(material: &Bssrdf<'_>, technique: Scattering) -> Result<BasisNumbers> {
    if technique == Scattering::Homogeneous {
        return Ok(basis(material, technique)?.numbers().clone());
    }
    let numbers = BasisNumbers::of(material).ok_or_else(no_basis)?;
    Ok(if technique == Scattering::Opaque { numbers.opaque() } else { numbers })
}

fn no_basis() -> Error {
    Error::Request(
        "the file has no separable basis: draw it by splat or gather, or add one with `subsurf encode --add-basis FILE`"
            .to_owned(),
    )
}

/// The mesh with vertices close enough to gather light at, and them as points that exchange light.
///
/// # Errors
/// The mesh would have too many vertices.
pub fn points(mesh: &Mesh, mapping: Mapping, material: &Bssrdf<'_>, scene: &Scene) -> Result<(Mesh, SurfacePoints)> {
    // Shares of the box are linear between the vertices of the mesh itself, as other techniques take them.
    let sides = (mapping == Mapping::Box).then(|| mesh.sides().into_owned());
    let fine = Mesh { sides, ..mesh.clone() }.subdivided(LONGEST_EDGE * material.header().pitch_mm)?;
    let visibilities = visibility(&fine, &scene.lights);
    let surface = SurfacePoints::new(&fine, mapping, material.header(), &visibilities);
    Ok((fine, surface))
}
