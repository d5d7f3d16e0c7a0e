//! A mesh whose scattering is precomputed.

use serde_json::{Map, json};
use subsurf_decoder::Transfer;
use subsurf_runtime::Gpu;
use subsurf_scene::Mesh;
use subsurf_viewer::{GpuAsset, RenderRequest, RenderSession};

use super::Drawing;
use super::exposure::{SUPERSAMPLING, average_down};

/// Draws the mesh that a file is of, without a ground, which the file knows nothing of.
pub(super) fn draw_transfer(
    gpu: &Gpu,
    transfer: &Transfer<'_>,
    mesh: &Mesh,
    request: &RenderRequest,
) -> anyhow::Result<Drawing> {
    let large = request.size.map(|side| side * SUPERSAMPLING);
    let mut scene = request.scene(mesh);
    let asset = GpuAsset::transfer(gpu, mesh, transfer)?;
    let mut facts = Map::new();
    facts.insert("size".to_owned(), json!(request.size));
    facts.insert("triangles".to_owned(), json!(mesh.triangles.len()));
    facts.insert("gpu_bytes".to_owned(), json!(asset.material_bytes()));
    let mut session = RenderSession::new(gpu, asset, &scene, large, request.options)?;
    session.expose(gpu, &mut scene, request.exposure)?;
    let picture = average_down(&session.picture(gpu, &scene)?, large);
    Ok(Drawing { picture, exposure: scene.camera.exposure, facts })
}
