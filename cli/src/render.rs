//! `subsurf render`: a picture of a material, flat or on a mesh.

use std::path::PathBuf;
use std::str::FromStr;
use std::time::Instant;

use glam::Vec3;
use image::RgbImage;
use serde_json::{Map, Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::check_target;
use subsurf_encoder::metrics::Light;
use subsurf_runtime::scene::{Mapping, Mesh, Surface};
use subsurf_runtime::{
    BACKGROUND, Gpu, GpuMesh, Material, MeshLight, MeshRenderer, PatchLight, PatchRenderer, Region, SeparableMaterial,
    SeparableRenderer, View, storage_of,
};
use subsurf_shaders::cpu::{self, Rgb};
use subsurf_shaders::separable::{Detail, Factors};

use crate::devices::{self, BackendArg, check_picture};
use crate::failure::bad_request;
use crate::info::{parse, read_file};
use crate::memory::human;
use crate::mesh::{self, Up};
use crate::options::Size;
use crate::picture::{image, write_png};
use crate::say::say;

/// Draw a material, flat or on a mesh, by the reference pass: every point gathers from all others within reach.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The .subsurf file
    file: PathBuf,
    /// The PNG to write
    #[arg(long, short)]
    output: PathBuf,
    /// Draw it on this mesh: .obj, .ply, .glb or .gltf
    #[arg(long)]
    mesh: Option<PathBuf>,
    /// Longest side of the mesh in mm: the material has its real size
    #[arg(long, default_value_t = 60.0, value_name = "MM", requires = "mesh")]
    extent: f32,
    /// How a flat patch is computed
    #[arg(long, value_enum, default_value = "gather", conflicts_with = "mesh")]
    path: PathArg,
    /// Which way is up in the mesh
    #[arg(long, value_enum, default_value = "y", requires = "mesh")]
    up: Up,
    /// Where the material lies on the mesh
    #[arg(long, value_enum, default_value = "auto", requires = "mesh")]
    mapping: MappingArg,
    /// From where the mesh is seen: degrees around, degrees up
    #[arg(long, default_value = "30,15", value_name = "AROUND,UP", requires = "mesh", allow_hyphen_values = true)]
    view: Angles,
    /// uniform, disc or line on a patch; a direction X,Y,Z towards the light on a mesh
    #[arg(long, value_name = "LIGHT", allow_hyphen_values = true)]
    light: Option<LightArg>,
    /// What to multiply light by before tone mapping; chosen from the picture if not given
    #[arg(long)]
    exposure: Option<f32>,
    /// Pixels of the picture
    #[arg(long, default_value = "960x720", value_name = "WxH")]
    size: Size,
    /// What draws
    #[arg(long, value_enum, default_value = "auto")]
    backend: BackendArg,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum PathArg {
    /// Light from every pixel of the window: the reference
    Gather,
    /// Weighted irradiance maps and shared Gaussians: many times faster, and an approximation
    Separable,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum MappingArg {
    /// Texture coordinates if the mesh has any, repeated so that the material keeps its size; else box
    Auto,
    /// Texture coordinates
    Uv,
    /// Projected from the side that each normal faces most
    Box,
}

/// Light on a patch or on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
enum LightArg {
    Pattern(Light),
    Direction(Vec3),
}

impl FromStr for LightArg {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Some(light) = Light::ALL.into_iter().find(|light| light.name() == text) {
            return Ok(Self::Pattern(light));
        }
        let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[x, y, z]) if Vec3::new(x, y, z).try_normalize().is_some() => {
                Ok(Self::Direction(Vec3::new(x, y, z).normalize()))
            }
            _ => Err("expected uniform, disc, line or a direction such as 1,2,1".to_owned()),
        }
    }
}

/// Degrees around the up axis and above the horizon.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Angles {
    around: f32,
    up: f32,
}

impl FromStr for Angles {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let numbers: Option<Vec<f32>> = text.split(',').map(|number| number.trim().parse().ok()).collect();
        match numbers.as_deref() {
            Some(&[around, up]) if up.abs() < 90.0 && around.is_finite() => Ok(Self { around, up }),
            _ => Err("expected two angles in degrees, the second between -90 and 90, such as 30,15".to_owned()),
        }
    }
}

/// Pictures are drawn this much larger and averaged down, so that edges are smooth.
const SUPERSAMPLING: u32 = 2;
/// Display value that the brightest parts get when the exposure is chosen.
const BRIGHT: f32 = 0.75;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    check_target(&args.output)?;
    check_picture(args.size.0)?;
    if let Some(exposure) = args.exposure
        && !(exposure.is_finite() && exposure > 0.0)
    {
        return Err(bad_request(format!("--exposure is {exposure}; it must be positive")));
    }
    let bytes = read_file(&args.file)?;
    let material = parse(&args.file, &bytes)?;
    let gpu = args.backend.open()?;
    let start = Instant::now();
    let (picture, facts) = match (&args.mesh, args.light) {
        (None, None) => draw_patch(gpu.as_ref(), &material, args.path, Light::Disc, args.size.0, args.exposure)?,
        (None, Some(LightArg::Pattern(light))) => {
            draw_patch(gpu.as_ref(), &material, args.path, light, args.size.0, args.exposure)?
        }
        (None, Some(LightArg::Direction(_))) => {
            return Err(bad_request("--light X,Y,Z is for meshes; on a patch it is uniform, disc or line"));
        }
        (Some(_), Some(LightArg::Pattern(_))) => {
            return Err(bad_request(
                "--light uniform, disc and line are for patches; on a mesh it is a direction X,Y,Z",
            ));
        }
        (Some(path), light) => {
            let direction = match light {
                Some(LightArg::Direction(direction)) => direction,
                _ => DEFAULT_LIGHT.normalize(),
            };
            let mesh = mesh::load(path, args.extent, args.up)?;
            let shot = Shot { direction, angles: args.view, size: args.size.0, exposure: args.exposure };
            draw_mesh(gpu.as_ref(), &material, mesh, args.mapping, &shot)?
        }
    };
    write_png(&args.output, &picture)?;
    let seconds = start.elapsed().as_secs_f64();
    let device = devices::name(gpu.as_ref());
    if args.json {
        let mut value = json!({ "file": args.output, "device": device, "seconds": seconds });
        if let Some(value) = value.as_object_mut() {
            value.extend(facts);
        }
        say!("{value:#}");
    } else {
        say!("{}: drawn by {device} in {seconds:.1} s", args.output.display());
        if let Some(bytes) = facts.get("gpu_bytes").and_then(Value::as_u64) {
            say!("  the material takes {} on the device", human(bytes));
        }
    }
    Ok(())
}

/// From over the right shoulder.
const DEFAULT_LIGHT: Vec3 = Vec3::new(0.9, 1.1, 0.35);

/// One picture of a mesh.
pub(crate) struct Shot {
    pub(crate) direction: Vec3,
    pub(crate) angles: Angles,
    pub(crate) size: [u32; 2],
    pub(crate) exposure: Option<f32>,
}

impl Shot {
    /// The usual picture of `size`.
    pub(crate) fn usual(size: [u32; 2]) -> Self {
        Self { direction: DEFAULT_LIGHT.normalize(), angles: Angles { around: 30.0, up: 15.0 }, size, exposure: None }
    }
}

/// Irradiance of a pattern on every pixel of a patch, as it is after it has entered.
pub(crate) fn patch_irradiance(material: &Bssrdf<'_>, light: Light) -> Vec<Rgb> {
    let size = [material.header().width as usize, material.header().height as usize];
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
    pixels.map(|pixel| [light.irradiance(pixel, size); 3]).collect()
}

/// Draws the whole patch, each of its pixels a block.
pub(crate) fn draw_patch(
    gpu: Option<&Gpu>,
    material: &Bssrdf<'_>,
    path: PathArg,
    light: Light,
    size: [u32; 2],
    exposure: Option<f32>,
) -> anyhow::Result<(RgbImage, Map<String, Value>)> {
    let header = material.header();
    let whole = Region { origin: [0, 0], size: [header.width, header.height] };
    // The patch keeps its shape.
    let scale = (0..2).map(|k| f64::from(size[k]) / f64::from(whole.size[k])).fold(f64::INFINITY, f64::min);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "no larger than `size`")]
    let size = whole.size.map(|side| ((f64::from(side) * scale).round() as u32).max(1));
    let irradiance = patch_irradiance(material, light);
    let mut facts = Map::new();
    facts.insert("light".to_owned(), json!(light.name()));
    facts.insert("size".to_owned(), json!(size));
    let pixels = match gpu {
        Some(gpu) => {
            let renderer = PatchRenderer::new(gpu, storage_of(material))?;
            let light = PatchLight::upload(gpu, whole.size, &irradiance)?;
            let (exitance, gpu_bytes) = match path {
                PathArg::Gather => {
                    let uploaded = Material::upload(gpu, material)?;
                    (renderer.gather(gpu, &uploaded, &light, whole)?, uploaded.gpu_bytes())
                }
                PathArg::Separable => {
                    let uploaded = SeparableMaterial::upload(gpu, &Factors::of(material, Detail::default()))?;
                    let renderer = SeparableRenderer::new(gpu, uploaded.terms())?;
                    let patch = renderer.prepare(gpu, &uploaded, &light)?;
                    renderer.draw(gpu, &patch)?;
                    (patch.into_exitance(), uploaded.gpu_bytes())
                }
            };
            let exposure = match exposure {
                Some(exposure) => exposure,
                None => exposure_for(exitance.read(gpu)?.iter()),
            };
            facts.insert("gpu_bytes".to_owned(), json!(gpu_bytes));
            facts.insert("exposure".to_owned(), json!(exposure));
            renderer.picture(gpu, &exitance, size, exposure)?
        }
        None => {
            let exitance = match path {
                PathArg::Gather => cpu::gather(material, &irradiance, whole.origin, whole.size),
                PathArg::Separable => cpu::separable(&Factors::of(material, Detail::default()), &irradiance),
            };
            let exposure = exposure.unwrap_or_else(|| exposure_for(exitance.iter()));
            facts.insert("exposure".to_owned(), json!(exposure));
            cpu::present(&exitance, whole.size, size, exposure)
        }
    };
    Ok((image(&pixels, size[0]), facts))
}

/// The exposure that brings all but the brightest hundredth below [`BRIGHT`].
fn exposure_for<'a>(lights: impl Iterator<Item = &'a Rgb>) -> f32 {
    let mut values: Vec<f32> = lights.map(|rgb| rgb.iter().copied().fold(0.0, f32::max)).collect();
    values.sort_by(f32::total_cmp);
    let bright = values.get(values.len() * 99 / 100).copied().unwrap_or(0.0);
    if bright > 0.0 { BRIGHT / bright } else { 1.0 }
}

/// Longest edge of the mesh that is drawn, in pixels of the material.
const LONGEST_EDGE: f32 = 1.5;

/// Draws a mesh made of the material.
pub(crate) fn draw_mesh(
    gpu: Option<&Gpu>,
    material: &Bssrdf<'_>,
    mesh: Mesh,
    mapping: MappingArg,
    shot: &Shot,
) -> anyhow::Result<(RgbImage, Map<String, Value>)> {
    let header = material.header();
    let given = mesh.triangles.len();
    let mapping = choose_mapping(&mesh, mapping, material)?;
    let mesh = mesh.subdivided(LONGEST_EDGE * header.pitch_mm)?;
    let visibility = mesh::visibility(&mesh, shot.direction);
    let surface = Surface::new(&mesh, mapping, header, &visibility);
    let light = MeshLight { direction: shot.direction, irradiance: [3.0, 2.9, 2.7], sky: [0.35, 0.4, 0.5] };
    let large = shot.size.map(|side| side * SUPERSAMPLING);
    let view = frame(&mesh, shot, light.sky);

    let mut facts = Map::new();
    facts.insert("size".to_owned(), json!(shot.size));
    facts.insert("triangles".to_owned(), json!(given));
    facts.insert("points".to_owned(), json!(surface.len()));
    facts.insert("mapping".to_owned(), json!(format!("{mapping:?}")));
    // Light that leaves becomes radiance by 1/π. Dark materials stay dark enough that what they reflect is not burnt out.
    let brightest_sky = light.sky.iter().copied().fold(0.0, f32::max);
    let exposure_of = |exitance: &[Rgb]| {
        let chosen = || exposure_for(exitance.iter()).min(BRIGHT / brightest_sky) * std::f32::consts::PI;
        shot.exposure.unwrap_or_else(chosen)
    };
    let pixels = match gpu {
        Some(gpu) => {
            let uploaded = Material::upload(gpu, material)?;
            let renderer = MeshRenderer::new(gpu, uploaded.storage())?;
            let on_gpu = GpuMesh::upload(gpu, &mesh, &surface)?;
            let exitance = renderer.exitance(gpu, &uploaded, &on_gpu, &light)?;
            let exposure = exposure_of(&exitance.read(gpu)?);
            facts.insert("gpu_bytes".to_owned(), json!(uploaded.gpu_bytes()));
            facts.insert("exposure".to_owned(), json!(exposure));
            let camera = View { exposure, ..view }.block(large, header.eta);
            renderer.picture(gpu, &on_gpu, &exitance, &camera, large)?
        }
        None => {
            let irradiance = cpu::irradiance(surface.normals(), &light.block(header.eta));
            let exitance = cpu::surface_gather(material, &surface.points(), &irradiance);
            let exposure = exposure_of(&exitance);
            facts.insert("exposure".to_owned(), json!(exposure));
            let exitances: Vec<Rgb> = surface.point_of().iter().map(|&point| exitance[point as usize]).collect();
            let triangles = cpu::Triangles {
                positions: &mesh.positions,
                normals: &mesh.normals,
                exitances: &exitances,
                triangles: &mesh.triangles,
            };
            let camera = View { exposure, ..view }.block(large, header.eta);
            cpu::shade(&triangles, &camera, large, [BACKGROUND; 3])
        }
    };
    Ok((average_down(&pixels, large), facts))
}

/// Repeats texture coordinates so that the material has its own size on average, a whole number of times.
fn choose_mapping(mesh: &Mesh, mapping: MappingArg, material: &Bssrdf<'_>) -> anyhow::Result<Mapping> {
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

/// A view in which the mesh fills the picture.
fn frame(mesh: &Mesh, shot: &Shot, sky: Rgb) -> View {
    const ANGLE: f32 = 0.5;
    let [low, high] = mesh.bounds();
    let target_mm = 0.5 * (low + high);
    let (around, up) = (shot.angles.around.to_radians(), shot.angles.up.to_radians());
    let towards = Vec3::new(up.cos() * around.sin(), up.sin(), up.cos() * around.cos());
    let radius = mesh.positions.iter().map(|position| position.distance(target_mm)).fold(0.0, f32::max);
    #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
    let aspect = (shot.size[0] as f32 / shot.size[1] as f32).min(1.0);
    let distance = 1.02 * radius / (0.5 * ANGLE).sin() / aspect;
    View { eye_mm: target_mm + distance * towards, target_mm, angle: ANGLE, exposure: 1.0, sky }
}

/// Means of blocks of pixels, taken of light rather than of display values.
fn average_down(pixels: &[[u8; 3]], size: [u32; 2]) -> RgbImage {
    let light: Vec<f32> = (0..=255_u8)
        .map(|value| {
            let value = f32::from(value) / 255.0;
            if value <= 0.040_45 { value / 12.92 } else { ((value + 0.055) / 1.055).powf(2.4) }
        })
        .collect();
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
