//! A mesh with all that it is drawn by: of a kernel, or of a transfer.

use serde_json::{Map, json};
use subsurf_decoder::{Kernel, Transfer};
use subsurf_runtime::Gpu;
use subsurf_scene::{AmbientTransfer, Mesh};
use subsurf_viewer::{GpuAsset, RenderRequest, RenderSession};

use super::Drawing;
use super::exposure::{SUPERSAMPLING, average_down};

/// Draws a mesh made of a homogeneous material, with the ground of its set.
pub(super) fn draw_kernel(
    gpu: &Gpu,
    kernel: &Kernel<'_>,
    mesh: &Mesh,
    request: &RenderRequest,
) -> anyhow::Result<Drawing> {
    let all = request.set.with_ground(mesh);
    let asset = GpuAsset::kernel(gpu, &all, kernel, &AmbientTransfer::of_kernel(&all, kernel)?)?;
    draw(gpu, asset, [mesh, &all], request)
}

/// Draws the mesh that a transfer is of, without a ground, which the file knows nothing of.
pub(super) fn draw_transfer(
    gpu: &Gpu,
    transfer: &Transfer<'_>,
    mesh: &Mesh,
    request: &RenderRequest,
) -> anyhow::Result<Drawing> {
    draw(gpu, GpuAsset::transfer(gpu, mesh, transfer)?, [mesh; 2], request)
}

/// Draws an asset; the set stands around `mesh`, and `all` is what the asset has of both.
fn draw(gpu: &Gpu, asset: GpuAsset, [mesh, all]: [&Mesh; 2], request: &RenderRequest) -> anyhow::Result<Drawing> {
    let large = request.size.map(|side| side * SUPERSAMPLING);
    let mut scene = request.scene(mesh);
    let mut facts = Map::new();
    facts.insert("size".to_owned(), json!(request.size));
    facts.insert("triangles".to_owned(), json!(all.triangles.len()));
    facts.insert("gpu_bytes".to_owned(), json!(asset.material_bytes()));
    let mut session = RenderSession::new(gpu, asset, &scene, large, request.options)?;
    session.expose(gpu, &mut scene, request.exposure)?;
    let picture = average_down(&session.picture(gpu, &scene)?, large);
    Ok(Drawing { picture, exposure: scene.camera.exposure, facts })
}
