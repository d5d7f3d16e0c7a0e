//! A mesh made of a BTF, and the images that it was made from beside it.

use serde_json::{Map, json};
use subsurf_decoder::NestedBtf;
use subsurf_runtime::{BACKGROUND, BtfMaterial, Gpu, RuntimeOptions};
use subsurf_scene::{Mesh, Placement, REFLECTION_SIZE, Scene, visibility};
use subsurf_shaders::{cpu, uniform};
use subsurf_viewer::{GpuAsset, RenderRequest, RenderSession, TexturedMesh, expect_uvs, exposure_of, upload_images};

use super::Drawing;
use super::btf_args::BtfArgs;
use super::exposure::{SUPERSAMPLING, average_down};
use crate::images::FolderImages;
use crate::picture::montage;

/// Draws a mesh made of a BTF, with the ground of its set; where there are images, which need a device, they come second.
pub(crate) fn draw_btf(
    gpu: Option<&Gpu>,
    btf: &NestedBtf<'_>,
    mesh: &Mesh,
    args: &BtfArgs,
    request: &RenderRequest,
) -> anyhow::Result<Drawing> {
    expect_uvs(mesh)?;
    let number = args.number(btf)?;
    let size = btf.materials().nth(number).map_or([1; 2], |material| material.size(0));
    let copies = args.copies(mesh, size);
    let options = RuntimeOptions { btf: args.options(request.options.btf), ..request.options };
    let large = request.size.map(|side| side * SUPERSAMPLING);
    let mut scene = request.scene(mesh);
    let mesh = &*request.set.with_ground(mesh);
    let mut facts = Map::new();
    facts.insert("size".to_owned(), json!(request.size));
    facts.insert("triangles".to_owned(), json!(mesh.triangles.len()));
    facts.insert("repeat".to_owned(), json!(copies));
    facts.insert("samples".to_owned(), json!(options.btf.samples));
    let Some(gpu) = gpu else {
        let surface =
            cpu::BtfSurface { btf, material: number, filtering: options.btf.filtering, samples: options.btf.samples };
        let (picture, exposure) = on_cpu(&surface, mesh, copies, &scene, request.exposure, large)?;
        return Ok(Drawing { picture: average_down(&picture, large), exposure, facts });
    };
    let mut draw = |material: BtfMaterial, number: usize, scene: &mut Scene, exposure: Option<f32>, name: &str| {
        facts.insert(name.to_owned(), json!(material.gpu_bytes()));
        let mut session =
            RenderSession::new(gpu, GpuAsset::btf(gpu, mesh, copies, material, number)?, scene, large, options)?;
        session.expose(gpu, scene, exposure)?;
        anyhow::Ok(average_down(&session.picture(gpu, scene)?, large))
    };
    let picture = draw(BtfMaterial::upload(gpu, btf)?, number, &mut scene, request.exposure, "gpu_bytes")?;
    let picture = match &args.images {
        None => picture,
        Some(folder) => {
            let images = FolderImages::read(folder)?;
            let exposure = Some(scene.camera.exposure);
            let beside = draw(upload_images(gpu, &images)?, 0, &mut scene, exposure, "images_gpu_bytes")?;
            montage(&[vec![picture, beside]])
        }
    };
    Ok(Drawing { picture, exposure: scene.camera.exposure, facts })
}

/// The same by the twin of the shaders, with the exposure; shadows are known of vertices only.
fn on_cpu(
    surface: &cpu::BtfSurface<'_>,
    mesh: &Mesh,
    copies: [f32; 2],
    scene: &Scene,
    exposure: Option<f32>,
    size: [u32; 2],
) -> anyhow::Result<(Vec<[u8; 3]>, f32)> {
    let visibilities = visibility(mesh, &scene.lights);
    let textured = TexturedMesh::new(mesh, copies)?;
    let triangles = textured.triangles(mesh, &visibilities);
    let reflections = cpu::Reflections { size: REFLECTION_SIZE, levels: scene.environment.reflections() };
    let placement = Placement::of_btf(mesh, copies);
    let draw = |exposure, size| {
        let mut block = uniform::Blocks::new(scene, &placement, size, RuntimeOptions::default().light_texels);
        block.scene.exposure = exposure;
        cpu::shade_btf(&triangles, surface, &block.scene, &reflections, size, [BACKGROUND; 3])
    };
    let exposure = exposure.unwrap_or_else(|| exposure_of(|dark| draw(dark, size.map(|side| side.div_ceil(4)))));
    Ok((draw(exposure, size), exposure))
}
