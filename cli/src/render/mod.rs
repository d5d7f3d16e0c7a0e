//! `subsurf render`: a picture of a material, flat or on a mesh.

mod btf;
mod mesh;
mod patch;
mod prepared;

use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::time::Instant;

use glam::Vec3;
use image::RgbImage;
use serde_json::{Map, Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::check_target;
use subsurf_encoder::metrics::Light;
use subsurf_runtime::{RuntimeOptions, TargetFormat};
use subsurf_scene::{Environment, load_mesh};
use subsurf_shaders::{Rgb, cpu};

use crate::devices::{self, BackendArg, check_picture};
use crate::failure::bad_request;
use crate::info::{Parsed, parse_any, read_file};
use crate::memory::human;
use crate::options::{Size, UpArg};
use crate::picture::write_png;
use crate::say::say;

pub(crate) use btf::{BtfArgs, Textured, draw_btf, expect_uvs, in_bytes, prepare_btf, read_images, upload_images};
pub(crate) use mesh::{ROUGHNESS, Shot, choose_mapping, chosen_exposure, draw_mesh};
pub(crate) use patch::{draw_patch, patch_irradiance};
pub(crate) use prepared::{Ingredients, Prepared, Ready};

/// Draw a material: a translucent one flat or on a mesh, by the reference path or by a fast one; a BTF on a mesh.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The .subsurf file
    file: PathBuf,
    /// The PNG to write
    #[arg(long, short)]
    output: PathBuf,
    /// Draw it on this mesh: a file (.obj, .ply, .glb, .gltf), or one of knot, bowl, drapery, relief, sphere, torus; a BTF
    /// on the knot if not given
    #[arg(long, value_name = "FILE|SHAPE")]
    mesh: Option<PathBuf>,
    /// Longest side of the mesh in mm: a translucent material has its real size
    #[arg(long, default_value_t = 60.0, value_name = "MM", requires = "mesh")]
    extent: f32,
    /// How light scatters in a translucent material; gather if not given
    #[arg(long, value_enum)]
    path: Option<PathArg>,
    /// Light from all around: an equirectangular picture, .hdr or .png; a dim studio if not given
    #[arg(long, value_name = "FILE", requires = "mesh")]
    environment: Option<PathBuf>,
    /// How rough the coat of a translucent material is that reflects it, 0 to 1; 0.25 if not given
    #[arg(long, requires = "mesh")]
    roughness: Option<f32>,
    /// Which way is up in the mesh
    #[arg(long, value_enum, default_value = "y", requires = "mesh")]
    up: UpArg,
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
    #[command(flatten)]
    btf: BtfArgs,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(crate) enum PathArg {
    /// Every point gathers light from all others within reach: the reference
    Gather,
    /// Every place that the light reaches is spread over what lies around it; for meshes
    Splat,
    /// Weighted irradiance maps and shared Gaussians: many times faster, and an approximation
    Separable,
    /// The same with one mean profile everywhere, as if the material were not heterogeneous; for comparison
    Homogeneous,
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

const EXAMPLES: &str = "\
Examples:
  subsurf render jade.subsurf -o patch.png --light line
  subsurf render jade.subsurf -o bunny.png --mesh bunny.ply --path separable
  subsurf render leather.subsurf -o leather.png
  subsurf render leather.subsurf -o sofa.png --mesh sofa.glb --repeat 8 --environment room.hdr --samples 32
  subsurf render leather.subsurf -o both.png --images leather/        the file and the images, side by side";

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

/// Display value that the brightest parts get when the exposure is chosen.
const BRIGHT: f32 = 0.75;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    check_target(&args.output)?;
    check_picture(args.size.0)?;
    args.btf.check()?;
    if let Some(exposure) = args.exposure
        && !(exposure.is_finite() && exposure > 0.0)
    {
        return Err(bad_request(format!("--exposure is {exposure}; it must be positive")));
    }
    if let Some(roughness) = args.roughness.filter(|roughness| !(0.0..=1.0).contains(roughness)) {
        return Err(bad_request(format!("--roughness is {roughness}; it must be between 0 and 1")));
    }
    let bytes = read_file(&args.file)?;
    let start = Instant::now();
    let (picture, facts, device) = match parse_any(&args.file, &bytes)? {
        Parsed::Bssrdf(material) => draw_bssrdf(args, &material)?,
        Parsed::Btf(btf) => {
            args.refuse_scattering()?;
            let gpu = args.backend.open()?;
            let shape = args.mesh.as_deref().unwrap_or(Path::new(BTF_SHAPE));
            let mesh = load_mesh(shape, args.extent, args.up.into())?;
            let (picture, facts) = draw_btf(gpu.as_ref(), &btf, &mesh, &args.btf, &args.shot()?)?;
            (picture, facts, devices::name(gpu.as_ref()))
        }
    };
    write_png(&args.output, &picture)?;
    let seconds = start.elapsed().as_secs_f64();
    if args.json {
        let mut value = json!({ "file": args.output, "device": device, "seconds": seconds });
        if let Some(value) = value.as_object_mut() {
            value.extend(facts);
        }
        say!("{value:#}");
    } else {
        say!("{}: drawn by {device} in {seconds:.1} s", args.output.display());
        for (fact, what) in [("gpu_bytes", "the material takes"), ("images_gpu_bytes", "its images take")] {
            if let Some(bytes) = facts.get(fact).and_then(Value::as_u64) {
                say!("  {what} {} on the device", human(bytes));
            }
        }
    }
    Ok(())
}

/// What a BTF is drawn on if nothing is said.
const BTF_SHAPE: &str = "knot";

/// A translucent material, flat or on a mesh; and what drew it.
fn draw_bssrdf(args: &Args, material: &Bssrdf<'_>) -> anyhow::Result<(RgbImage, Map<String, Value>, String)> {
    args.btf.expect_none()?;
    let path = args.path.unwrap_or(PathArg::Gather);
    let is_separable = matches!(path, PathArg::Separable | PathArg::Homogeneous);
    let mut gpu = args.backend.open()?;
    let is_short_of_halves = gpu.as_ref().is_some_and(|gpu| gpu.target_format() == TargetFormat::Packed);
    if is_short_of_halves && is_separable && args.mesh.is_none() && args.backend == BackendArg::Auto {
        // The CPU does what the device cannot.
        gpu = None;
    }
    let flat = |light| draw_patch(gpu.as_ref(), material, path, light, args.size.0, args.exposure);
    let (picture, facts) = match (&args.mesh, args.light) {
        (None, None) => flat(Light::Disc)?,
        (None, Some(LightArg::Pattern(light))) => flat(light)?,
        (None, Some(LightArg::Direction(_))) => {
            return Err(bad_request("--light X,Y,Z is for meshes; on a patch it is uniform, disc or line"));
        }
        (Some(shape), _) => {
            let mesh = load_mesh(shape, args.extent, args.up.into())?;
            draw_mesh(gpu.as_ref(), material, &mesh, args.mapping, path, &args.shot()?)?
        }
    };
    Ok((picture, facts, devices::name(gpu.as_ref())))
}

impl Args {
    /// The picture of a mesh that is asked for.
    fn shot(&self) -> anyhow::Result<Shot> {
        Ok(Shot {
            direction: match self.light {
                None => mesh::DEFAULT_LIGHT.normalize(),
                Some(LightArg::Direction(direction)) => direction,
                Some(LightArg::Pattern(_)) => {
                    return Err(bad_request(
                        "--light uniform, disc and line are for patches; on a mesh it is a direction X,Y,Z",
                    ));
                }
            },
            environment: match &self.environment {
                Some(path) => read_environment(path)?,
                None => Environment::studio(),
            },
            roughness: self.roughness.unwrap_or(mesh::ROUGHNESS),
            angles: self.view,
            size: self.size.0,
            exposure: self.exposure,
            options: RuntimeOptions::default(),
        })
    }

    /// Refuses options that say nothing to a BTF.
    fn refuse_scattering(&self) -> anyhow::Result<()> {
        let given = [
            ("--path", self.path.is_some()),
            ("--roughness", self.roughness.is_some()),
            ("--mapping box", self.mapping == MappingArg::Box),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((name, _)) => Err(bad_request(format!("{name} is for translucent materials; this file is a BTF"))),
            None => Ok(()),
        }
    }
}

/// An equirectangular picture; 8-bit ones are taken as sRGB.
pub(crate) fn read_environment(path: &Path) -> anyhow::Result<Environment> {
    let wrong = |reason: String| bad_request(format!("{}: {reason}", path.display()));
    let picture = image::open(path).map_err(|error| wrong(error.to_string()))?;
    let is_linear = matches!(picture.color(), image::ColorType::Rgb32F | image::ColorType::Rgba32F);
    let picture = picture.into_rgb32f();
    let size = [picture.width(), picture.height()];
    let decoded = |pixel: Rgb| if is_linear { pixel } else { cpu::linear(pixel) };
    let pixels: Vec<Rgb> = picture.pixels().map(|pixel| decoded(pixel.0)).collect();
    Environment::equirectangular(size, &pixels).map_err(|error| wrong(error.to_string()))
}

/// The exposure that brings all but the brightest hundredth below [`BRIGHT`].
fn exposure_for<'a>(lights: impl Iterator<Item = &'a Rgb>) -> f32 {
    let mut values: Vec<f32> = lights.map(|rgb| rgb.iter().copied().fold(0.0, f32::max)).collect();
    values.sort_by(f32::total_cmp);
    let bright = values.get(values.len() * 99 / 100).copied().unwrap_or(0.0);
    if bright > 0.0 { BRIGHT / bright } else { 1.0 }
}
