//! Rivals beside our techniques: LinSSS by fits of `subsurf-study linsss`, as its authors' shortcut draws them and by blurs of everything;
//! separable kernels of the same material.

use std::path::Path;

use subsurf_cli::program::failure::bad_request;
use subsurf_decoder::{Bssrdf, Kernel};
use subsurf_encoder::baseline::linsss::LinSss;
use subsurf_runtime::{Gpu, GpuMesh, LinsssMaterial, LinsssModel, Material, VertexData};
use subsurf_scene::{AmbientTransfer, Mapping, Mesh};
use subsurf_shaders::separable::ProjectedBasis;
use subsurf_viewer::{DrawnMaterial, GpuAsset, parse, read, stem};

/// Name and model of a rival.
pub(super) struct Rival {
    pub(super) name: String,
    pub(super) file_bytes: u64,
    model: Model,
}

/// What is drawn.
enum Model {
    Linsss(LinsssModel),
    /// File of a kernel.
    Kernel(Vec<u8>),
}

impl Rival {
    /// Kernel of a file, which has to be of a homogeneous material to compare with.
    pub(super) fn kernel(path: &Path) -> anyhow::Result<Self> {
        let bytes = read(path)?;
        let DrawnMaterial::Kernel(_) = parse(path, &bytes)? else {
            return Err(bad_request(format!(
                "{}: no kernel; `subsurf kernel FILE --base N` makes one",
                path.display()
            )));
        };
        let name = format!("kernel {}", stem(path));
        Ok(Self { name, file_bytes: bytes.len() as u64, model: Model::Kernel(bytes) })
    }

    /// Rivals whose fits are in a folder: NAME-linsssH.sss, of a material whose file is called NAME or NAME-k2.
    pub(super) fn linsss(folder: &Path, name: &str, material: &Bssrdf<'_>) -> anyhow::Result<Vec<Self>> {
        let header = material.header();
        let name = name.strip_suffix("-k2").unwrap_or(name);
        let albedo = ProjectedBasis::of(material).map(|basis| basis.albedo());
        let mut rivals = Vec::new();
        for count in 1..=8 {
            let path = folder.join(format!("{name}-linsss{count}.sss"));
            let Ok(bytes) = std::fs::read(&path) else {
                continue;
            };
            let fit = LinSss::parse(&bytes, header.pitch_mm)
                .filter(|fit| fit.size == [header.width as usize, header.height as usize]);
            let fit = fit.ok_or_else(|| {
                bad_request(format!("{}: no fit of this material; run subsurf-study linsss", path.display()))
            })?;
            let (sigmas_px, weights) = fit.on_the_plane();
            for is_shortcut in [false, true] {
                let model = LinsssModel {
                    header: *header,
                    sigmas_px: sigmas_px.clone(),
                    weights: weights.clone(),
                    albedo: albedo.clone().unwrap_or_default(),
                    is_shortcut,
                };
                let how = if is_shortcut { ", shortcut" } else { "" };
                rivals.push(Self {
                    name: format!("LinSSS {count}{how}"),
                    file_bytes: bytes.len() as u64,
                    model: Model::Linsss(model),
                });
            }
        }
        if rivals.is_empty() {
            let folder = folder.display();
            return Err(bad_request(format!(
                "{folder}: no fit of {name}; run subsurf-study linsss, which leaves {name}-linsss4.sss"
            )));
        }
        Ok(rivals)
    }

    /// Brings it and a mesh to a device.
    pub(super) fn upload(
        &self,
        gpu: &Gpu,
        mesh: &Mesh,
        mapping: Mapping,
        sky: Option<&[AmbientTransfer]>,
    ) -> subsurf_viewer::Result<GpuAsset> {
        match &self.model {
            Model::Linsss(model) => {
                let known = VertexData { ambient: sky, ..Default::default() };
                Ok(GpuAsset {
                    mesh: GpuMesh::upload(gpu, mesh, known)?,
                    material: Material::Linsss(LinsssMaterial::upload(gpu, model)?.into()),
                    mapping,
                })
            }
            Model::Kernel(bytes) => {
                let kernel = Kernel::parse(bytes).map_err(subsurf_runtime::Error::from)?;
                GpuAsset::kernel(gpu, mesh, &kernel, &AmbientTransfer::of_kernel(mesh, &kernel)?)
            }
        }
    }
}
