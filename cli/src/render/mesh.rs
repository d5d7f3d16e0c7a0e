//! A mesh made of the material, by one of the paths.

use glam::Vec3;
use image::RgbImage;
use serde_json::{Map, Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_runtime::{BACKGROUND, Frame, Gpu, Renderer, RuntimeOptions};
use subsurf_scene::{Camera, Environment, Light, LightShape, Mapping, Mesh, Placement, Scene};
use subsurf_shaders::uniform;
use subsurf_shaders::{Rgb, cpu};

use super::prepared::{Ingredients, Prepared, Ready, points};
use super::{Angles, BRIGHT, MappingArg, PathArg, exposure_for};
use crate::failure::bad_request;

/// Pictures are drawn this much larger and averaged down, so that edges are smooth.
pub(super) const SUPERSAMPLING: u32 = 2;
/// From over the right shoulder.
pub(super) const DEFAULT_LIGHT: Vec3 = Vec3::new(0.9, 1.1, 0.35);

/// One picture of a mesh.
pub(crate) struct Shot {
    pub(crate) direction: Vec3,
    pub(crate) environment: Environment,
    pub(crate) roughness: f32,
    pub(crate) angles: Angles,
    pub(crate) size: [u32; 2],
    pub(crate) exposure: Option<f32>,
    pub(crate) options: RuntimeOptions,
}

impl Shot {
    /// The usual picture of `size`.
    pub(crate) fn usual(size: [u32; 2]) -> Self {
        Self {
            direction: DEFAULT_LIGHT.normalize(),
            environment: Environment::studio(),
            roughness: ROUGHNESS,
            angles: Angles { around: 30.0, up: 15.0 },
            size,
            exposure: None,
            options: RuntimeOptions::default(),
        }
    }

    /// The scene in which the mesh fills the picture.
    pub(crate) fn scene(&self, mesh: &Mesh) -> Scene {
        Scene {
            lights: vec![Light {
                shape: LightShape::Directional { towards: self.direction },
                irradiance: [3.0, 2.9, 2.7],
            }],
            environment: self.environment.clone(),
            roughness: self.roughness,
            camera: frame(mesh, self.angles, self.size),
        }
    }
}

/// Of the usual coat: polished, but not a mirror.
pub(crate) const ROUGHNESS: f32 = 0.25;

/// Draws a mesh made of the material.
pub(crate) fn draw_mesh(
    gpu: Option<&Gpu>,
    material: &Bssrdf<'_>,
    mesh: &Mesh,
    mapping: MappingArg,
    path: PathArg,
    shot: &Shot,
) -> anyhow::Result<(RgbImage, Map<String, Value>)> {
    let mapping = choose_mapping(mesh, mapping, material)?;
    let large = shot.size.map(|side| side * SUPERSAMPLING);
    let mut scene = shot.scene(mesh);
    let mut facts = Map::new();
    facts.insert("size".to_owned(), json!(shot.size));
    facts.insert("triangles".to_owned(), json!(mesh.triangles.len()));
    facts.insert("mapping".to_owned(), json!(format!("{mapping:?}")));
    let pixels = match gpu {
        Some(gpu) => {
            let prepared =
                Ingredients::compute(material, mesh, mapping, &scene, path, None)?.upload(gpu, material, mesh)?;
            facts.insert("gpu_bytes".to_owned(), json!(prepared.material_bytes()));
            let mut ready = Ready::new(gpu, prepared, &scene, large, shot.options)?;
            scene.camera.exposure = match shot.exposure {
                Some(exposure) => exposure,
                None => ready.exposure(gpu, &scene)?,
            };
            ready.picture(gpu, &scene)?
        }
        None if path != PathArg::Gather => {
            return Err(bad_request("the CPU draws meshes by --path gather only; the other paths need a device"));
        }
        None => {
            let (fine, surface) = points(mesh, mapping, material, &scene)?;
            let placement = Placement::new(mesh, mapping, material.header());
            let mut block = uniform::Scene::new(&scene, &placement, large, shot.options.light_texels);
            let exitance = cpu::surface_gather(material, &surface, &cpu::irradiance(&block, &surface));
            let brightest = scene.environment.irradiance(Vec3::Y).iter().copied().fold(0.0, f32::max);
            let chosen = || exposure_for(exitance.iter()).min(BRIGHT / brightest.max(1e-6)) * std::f32::consts::PI;
            block.exposure = shot.exposure.unwrap_or_else(chosen);
            scene.camera.exposure = block.exposure;
            let of_vertices = || surface.point_of.iter().map(|&point| point as usize);
            let exitances: Vec<Rgb> = of_vertices().map(|point| exitance[point]).collect();
            let visibilities: Vec<_> = of_vertices().map(|point| surface.visibilities[point]).collect();
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
    facts.insert("exposure".to_owned(), json!(scene.camera.exposure));
    Ok((average_down(&pixels, large), facts))
}

/// The exposure that brings all but the brightest parts of a first picture below middle values: light materials keep their
/// colours.
pub(crate) fn chosen_exposure(
    gpu: &Gpu,
    renderer: &Renderer,
    frame: &mut Frame,
    prepared: &Prepared,
    scene: &Scene,
) -> anyhow::Result<f32> {
    let mut scene = scene.clone();
    let mut failed = Ok(());
    let exposure = exposure_of(|dark| {
        scene.camera.exposure = dark;
        renderer.picture(gpu, frame, &prepared.model(), &scene).unwrap_or_else(|error| {
            failed = Err(error);
            Vec::new()
        })
    });
    failed?;
    Ok(exposure)
}

/// The same for whatever draws a picture at an exposure.
pub(super) fn exposure_of(draw: impl FnOnce(f32) -> Vec<[u8; 3]>) -> f32 {
    // So dark that nothing is compressed, which is then undone.
    const DARK: f32 = 0.05;
    const MIDDLE: f32 = 0.5;
    let picture = draw(DARK);
    let mut values: Vec<f32> = picture
        .iter()
        .filter(|pixel| **pixel != [BACKGROUND; 3])
        .map(|pixel| light_of(*pixel).into_iter().fold(0.0, f32::max))
        .collect();
    values.sort_by(f32::total_cmp);
    let bright = values.get(values.len() * 97 / 100).copied().unwrap_or(0.0);
    if bright > 0.0 { DARK * MIDDLE / bright } else { 1.0 }
}

/// Repeats texture coordinates so that the material has its own size on average, a whole number of times.
pub(crate) fn choose_mapping(mesh: &Mesh, mapping: MappingArg, material: &Bssrdf<'_>) -> anyhow::Result<Mapping> {
    let uvs = match (mapping, &mesh.uvs) {
        (MappingArg::Uv, None) => {
            return Err(bad_request(
                "the mesh has no texture coordinates: unwrap it in a modelling program (in Blender: Edit Mode, UV, \
                 Smart UV Project) and export them, or draw it with --mapping box",
            ));
        }
        (MappingArg::Box, _) | (MappingArg::Auto, None) => return Ok(Mapping::Box),
        (MappingArg::Uv | MappingArg::Auto, Some(uvs)) => uvs,
    };
    let (mut area_mm2, mut area_uv) = (0.0_f64, 0.0_f64);
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|k| mesh.positions[k as usize]);
        let [ta, tb, tc] = triangle.map(|k| uvs[k as usize]);
        area_mm2 += f64::from((b - a).cross(c - a).length());
        area_uv += f64::from((tb - ta).perp_dot(tc - ta).abs());
    }
    let header = material.header();
    let mm_per_unit = if area_uv > 0.0 { (area_mm2 / area_uv).sqrt() } else { 0.0 };
    #[allow(clippy::cast_possible_truncation, reason = "a small whole number")]
    let times = |side: u32| (mm_per_unit / (f64::from(side) * f64::from(header.pitch_mm))).round().max(1.0) as f32;
    Ok(Mapping::Uv([times(header.width), times(header.height)]))
}

/// A view in which the mesh fills a picture of `size`.
fn frame(mesh: &Mesh, angles: Angles, size: [u32; 2]) -> Camera {
    const ANGLE: f32 = 0.5;
    let [low, high] = mesh.bounds();
    let target_mm = 0.5 * (low + high);
    let (around, up) = (angles.around.to_radians(), angles.up.to_radians());
    let towards = Vec3::new(up.cos() * around.sin(), up.sin(), up.cos() * around.cos());
    let radius = mesh.positions.iter().map(|position| position.distance(target_mm)).fold(0.0, f32::max);
    #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
    let aspect = (size[0] as f32 / size[1] as f32).min(1.0);
    let distance = 1.02 * radius / (0.5 * ANGLE).sin() / aspect;
    Camera { eye_mm: target_mm + distance * towards, target_mm, fov_y_rad: ANGLE, exposure: 1.0 }
}

/// Light of display values, 0 to 1.
fn light_of(pixel: [u8; 3]) -> Rgb {
    cpu::linear(pixel.map(|value| f32::from(value) / 255.0))
}

/// Means of blocks of pixels, taken of light rather than of display values.
pub(super) fn average_down(pixels: &[[u8; 3]], size: [u32; 2]) -> RgbImage {
    let light: Vec<f32> = (0..=255_u8).map(|value| light_of([value; 3])[0]).collect();
    let n = SUPERSAMPLING;
    RgbImage::from_fn(size[0] / n, size[1] / n, |x, y| {
        let mut sum = [0.0; 3];
        for (dx, dy) in (0..n).flat_map(|dy| (0..n).map(move |dx| (dx, dy))) {
            let pixel = pixels[((y * n + dy) * size[0] + x * n + dx) as usize];
            for c in 0..3 {
                sum[c] += light[usize::from(pixel[c])];
            }
        }
        #[allow(clippy::cast_precision_loss, reason = "a handful")]
        let count = (n * n) as f32;
        image::Rgb(cpu::display(cpu::srgb(sum.map(|sum| sum / count))))
    })
}
