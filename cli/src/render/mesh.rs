//! A mesh made of a translucent material, by one of the techniques.

use glam::Vec3;
use serde_json::{Map, json};
use subsurf_decoder::Bssrdf;
use subsurf_runtime::{BACKGROUND, Gpu};
use subsurf_scene::{Mesh, Placement};
use subsurf_shaders::cpu;
use subsurf_shaders::uniform;
use subsurf_viewer::{Asset, MappingChoice, RenderRequest, RenderSession, Scattering, choose_mapping, points};

use super::Drawing;
use super::exposure::{BRIGHT, SUPERSAMPLING, average_down, exposure_for};

/// Draws a mesh made of the material, with the ground of its set; without a device, by the reference technique only.
pub(crate) fn draw_mesh(
    gpu: Option<&Gpu>,
    material: &Bssrdf<'_>,
    mesh: &Mesh,
    mapping: MappingChoice,
    technique: Scattering,
    request: &RenderRequest,
) -> anyhow::Result<Drawing> {
    let mapping = choose_mapping(mesh, mapping, material)?;
    let large = request.size.map(|side| side * SUPERSAMPLING);
    let mut scene = request.scene(mesh);
    let mesh = &*request.set.with_ground(mesh);
    let mut facts = Map::new();
    facts.insert("size".to_owned(), json!(request.size));
    facts.insert("triangles".to_owned(), json!(mesh.triangles.len()));
    facts.insert("mapping".to_owned(), json!(format!("{mapping:?}")));
    let pixels = match gpu {
        Some(gpu) => {
            let asset =
                Asset::compute(material, mesh, mapping, &scene, technique, None)?.upload(gpu, material, mesh)?;
            facts.insert("gpu_bytes".to_owned(), json!(asset.material_bytes()));
            let mut session = RenderSession::new(gpu, asset, &scene, large, request.options)?;
            session.expose(gpu, &mut scene, request.exposure)?;
            session.picture(gpu, &scene)?
        }
        None => {
            assert_eq!(technique, Scattering::Gather, "the CPU draws meshes by the reference only");
            let (fine, surface) = points(mesh, mapping, material, &scene)?;
            let placement = Placement::new(mesh, mapping, material.header());
            let mut block = uniform::Blocks::new(&scene, &placement, large, request.options.light_texels);
            let exitance = cpu::surface_gather(material, &surface, &cpu::irradiance(&block, &surface));
            let brightest = scene.environment.irradiance(Vec3::Y).iter().copied().fold(0.0, f32::max);
            let chosen = || exposure_for(exitance.iter()).min(BRIGHT / brightest.max(1e-6)) * std::f32::consts::PI;
            block.scene.exposure = request.exposure.unwrap_or_else(chosen);
            scene.camera.exposure = block.scene.exposure;
            let exitances = surface.of_vertices(&exitance);
            let visibilities: Vec<_> =
                surface.point_of.iter().map(|&point| surface.visibilities[point as usize]).collect();
            let triangles = cpu::Triangles {
                positions: &fine.positions,
                normals: &fine.normals,
                exitances: &exitances,
                visibilities: &visibilities,
                triangles: &fine.triangles,
            };
            let reflections =
                cpu::Reflections { size: subsurf_scene::REFLECTION_SIZE, levels: scene.environment.reflections() };
            cpu::shade_vertex(&triangles, &block, &reflections, large, [BACKGROUND; 3])
        }
    };
    Ok(Drawing { picture: average_down(&pixels, large), exposure: scene.camera.exposure, facts })
}
