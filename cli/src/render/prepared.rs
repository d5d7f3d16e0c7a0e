//! A material and a mesh as a path wants them: computed, and then brought to a device.

use std::sync::Arc;

use subsurf_decoder::Bssrdf;
use subsurf_runtime::{
    AmbientTransfer, BtfMaterial, Drawable, Frame, Gpu, GpuMesh, GpuPoints, Material, Renderer, RuntimeOptions,
    SeparableMaterial, SplatMaterial, Technique, VertexData,
};
use subsurf_scene::{Mapping, Mesh, Placement, Scene, SurfacePoints, visibility};
use subsurf_shaders::separable::{BasisSize, SeparableBasis};

use super::PathArg;
use super::mesh::chosen_exposure;

/// Longest edge of the mesh between whose vertices light is gathered, in pixels of the material.
const LONGEST_EDGE: f32 = 1.5;
/// How close to the gather the separable path has to come on a flat patch, in dB.
const LEAST_DB: f32 = 40.0;

/// What takes long and needs no device.
pub(crate) struct Ingredients {
    mapping: Mapping,
    of_path: OfPath,
}

enum OfPath {
    Gather { fine: Mesh, surface: SurfacePoints },
    Splat { sky: Arc<Vec<AmbientTransfer>>, factors: SeparableBasis },
    Separable { sky: Arc<Vec<AmbientTransfer>>, factors: SeparableBasis },
}

impl Ingredients {
    /// `sky`, where it is known already for this mesh and material, is not computed again.
    pub(crate) fn compute(
        material: &Bssrdf<'_>,
        mesh: &Mesh,
        mapping: Mapping,
        scene: &Scene,
        path: PathArg,
        sky: Option<Arc<Vec<AmbientTransfer>>>,
    ) -> anyhow::Result<Self> {
        let sky = || match sky {
            Some(sky) => Ok(sky),
            None => AmbientTransfer::of(mesh, material).map(Arc::new),
        };
        let of_path = match path {
            PathArg::Gather => {
                let (fine, surface) = points(mesh, mapping, material, scene)?;
                OfPath::Gather { fine, surface }
            }
            PathArg::Splat => {
                OfPath::Splat { sky: sky()?, factors: SeparableBasis::of(material, BasisSize::default()) }
            }
            PathArg::Separable | PathArg::Homogeneous => {
                OfPath::Separable { sky: sky()?, factors: factors(material, path) }
            }
        };
        Ok(Self { mapping, of_path })
    }

    /// Light from all around, the same for all paths that want it.
    pub(crate) fn sky(&self) -> Option<&Arc<Vec<AmbientTransfer>>> {
        match &self.of_path {
            OfPath::Splat { sky, .. } | OfPath::Separable { sky, .. } => Some(sky),
            OfPath::Gather { .. } => None,
        }
    }

    /// Brings everything to a device.
    pub(crate) fn upload(&self, gpu: &Gpu, material: &Bssrdf<'_>, mesh: &Mesh) -> anyhow::Result<Prepared> {
        let placement = Placement::new(mesh, self.mapping, material.header());
        let shared = |sky: &[AmbientTransfer]| GpuMesh::upload(gpu, mesh, &placement, VertexData::Ambient(sky));
        Ok(match &self.of_path {
            OfPath::Gather { fine, surface } => Prepared::Gather {
                mesh: GpuMesh::upload(gpu, fine, &placement, VertexData::Points(&surface.point_of))?,
                points: GpuPoints::upload(gpu, surface)?,
                material: Material::upload(gpu, material)?,
            },
            OfPath::Splat { sky, factors } => {
                Prepared::Splat { mesh: shared(sky)?, material: SplatMaterial::upload(gpu, material, factors)? }
            }
            OfPath::Separable { sky, factors } => {
                Prepared::Separable { mesh: shared(sky)?, material: SeparableMaterial::upload(gpu, factors)? }
            }
        })
    }
}

/// SeparableBasis of a material, or of its mean.
pub(super) fn factors(material: &Bssrdf<'_>, path: PathArg) -> SeparableBasis {
    match path {
        PathArg::Homogeneous => SeparableBasis::homogeneous(material, BasisSize::default().gaussians),
        PathArg::Gather | PathArg::Splat | PathArg::Separable => SeparableBasis::within(material, LEAST_DB),
    }
}

/// The mesh with vertices close enough to gather light at, and them as points that exchange light.
pub(super) fn points(
    mesh: &Mesh,
    mapping: Mapping,
    material: &Bssrdf<'_>,
    scene: &Scene,
) -> anyhow::Result<(Mesh, SurfacePoints)> {
    let fine = mesh.clone().subdivided(LONGEST_EDGE * material.header().pitch_mm)?;
    let visibilities = visibility(&fine, &scene.lights);
    let surface = SurfacePoints::new(&fine, mapping, material.header(), &visibilities);
    Ok((fine, surface))
}

/// A material and a mesh on the device as a path wants them.
#[allow(clippy::large_enum_variant, reason = "one or two at a time, and they stay where they are")]
pub(crate) enum Prepared {
    Gather { mesh: GpuMesh, points: GpuPoints, material: Material },
    Splat { mesh: GpuMesh, material: SplatMaterial },
    Separable { mesh: GpuMesh, material: SeparableMaterial },
    Btf { mesh: GpuMesh, material: BtfMaterial, number: usize },
}

impl Prepared {
    pub(crate) fn mesh_bytes(&self) -> u64 {
        match self {
            Self::Gather { mesh, .. }
            | Self::Splat { mesh, .. }
            | Self::Separable { mesh, .. }
            | Self::Btf { mesh, .. } => mesh.gpu_bytes(),
        }
    }

    pub(crate) fn model(&self) -> Drawable<'_> {
        match self {
            Self::Gather { mesh, points, material } => Drawable::Gather { mesh, points, material },
            Self::Splat { mesh, material } => Drawable::Splat { mesh, material },
            Self::Separable { mesh, material } => Drawable::Separable { mesh, material },
            Self::Btf { mesh, material, number } => Drawable::Btf { mesh, material, number: *number },
        }
    }

    /// The renderer's name for the path.
    pub(crate) fn path(&self) -> Technique {
        match self {
            Self::Gather { material, .. } => Technique::Gather(material.layout()),
            Self::Splat { material, .. } => Technique::Splat(material.planes().layout()),
            Self::Separable { material, .. } => Technique::Separable(material.terms()),
            Self::Btf { material, .. } => Technique::Btf(material.layout()),
        }
    }

    pub(crate) fn material_bytes(&self) -> u64 {
        match self {
            Self::Gather { material, .. } => material.gpu_bytes(),
            Self::Splat { material, .. } => material.planes().gpu_bytes(),
            Self::Separable { material, .. } => material.gpu_bytes(),
            Self::Btf { material, .. } => material.gpu_bytes(),
        }
    }
}

/// Everything to draw pictures of one size with.
pub(crate) struct Ready {
    pub(crate) prepared: Prepared,
    pub(crate) renderer: Renderer,
    pub(crate) frame: Frame,
}

impl Ready {
    pub(crate) fn new(
        gpu: &Gpu,
        prepared: Prepared,
        scene: &Scene,
        size: [u32; 2],
        options: RuntimeOptions,
    ) -> anyhow::Result<Self> {
        let renderer = Renderer::new(gpu, prepared.path(), options)?;
        let frame = renderer.prepare(gpu, &prepared.model(), scene, size)?;
        Ok(Self { prepared, renderer, frame })
    }

    pub(crate) fn picture(&mut self, gpu: &Gpu, scene: &Scene) -> anyhow::Result<Vec<[u8; 3]>> {
        Ok(self.renderer.picture(gpu, &mut self.frame, &self.prepared.model(), scene)?)
    }

    pub(crate) fn exposure(&mut self, gpu: &Gpu, scene: &Scene) -> anyhow::Result<f32> {
        chosen_exposure(gpu, &self.renderer, &mut self.frame, &self.prepared, scene)
    }
}
