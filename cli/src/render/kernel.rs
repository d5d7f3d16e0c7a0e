//! A mesh made of a homogeneous material, by its separable kernel.

use serde_json::{Map, json};
use subsurf_decoder::Kernel;
use subsurf_runtime::Gpu;
use subsurf_scene::{AmbientTransfer, Mesh};
use subsurf_viewer::{GpuAsset, RenderRequest, RenderSession};

use super::Drawing;
use super::exposure::{SUPERSAMPLING, average_down};

/// Draws a mesh made of the material, with the ground of its set.
pub(super) fn draw_kernel(
    gpu: &Gpu,
    kernel: &Kernel<'_>,
    mesh: &Mesh,
    request: &RenderRequest,
) -> anyhow::Result<Drawing> {
    let large = request.size.map(|side| side * SUPERSAMPLING);
    let mut scene = request.scene(mesh);
    let mesh = &*request.set.with_ground(mesh);
    let asset = GpuAsset::kernel(gpu, mesh, kernel, &AmbientTransfer::of_kernel(mesh, kernel)?)?;
    let mut facts = Map::new();
    facts.insert("size".to_owned(), json!(request.size));
    facts.insert("triangles".to_owned(), json!(mesh.triangles.len()));
    facts.insert("gpu_bytes".to_owned(), json!(asset.material_bytes()));
    let mut session = RenderSession::new(gpu, asset, &scene, large, request.options)?;
    session.expose(gpu, &mut scene, request.exposure)?;
    let picture = average_down(&session.picture(gpu, &scene)?, large);
    Ok(Drawing { picture, exposure: scene.camera.exposure, facts })
}
