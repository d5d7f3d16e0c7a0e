//! `subsurf simulate`: a capture where nothing was measured.

pub mod btf;

use std::ops::RangeInclusive;
use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use serde_json::{Value, json};
use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::bssrdf::layout::LENGTHS_MM;
use subsurf_encoder::capture::{CaptureWriter, Scalar, Sidecar};
use subsurf_encoder::check_target;
use subsurf_encoder::simulate::maps::{self, MeanFreePath, Weight};
use subsurf_encoder::simulate::{Finish, MediumMap, Scene, Sensor, Slab, Summary, simulate};

use crate::options::{AddressingArg, Size};
use crate::outln;
use crate::program::failure::bad_request;
use crate::program::progress::Bars;
use subsurf_viewer::human;

/// Simulate a capture: light diffusing in a slab of given media, measured pixel by pixel.
///
/// Solves −∇·(D∇φ) + σ_a φ = Q below every pixel in turn, lit by a beam as wide as the pixel, and writes what leaves
/// the surface within the window: NAME.npy, floats of shape (height, width, D, D, 3) in mm⁻², and NAME.json beside it.
#[derive(clap::Args)]
#[command(after_help = MAPS_HELP, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    other: Option<Other>,
    #[command(flatten)]
    capture: Option<CaptureArgs>,
}

/// What is simulated but captures.
#[derive(clap::Subcommand)]
enum Other {
    Btf(btf::Args),
}

#[derive(clap::Args)]
struct CaptureArgs {
    /// A built-in material
    #[arg(long, value_enum, conflicts_with = "maps", required_unless_present = "maps")]
    scene: Option<SceneArg>,
    /// Your own images: NAME=VALUE, once for each; see below
    #[arg(long, value_name = "NAME=VALUE")]
    maps: Vec<String>,
    /// Spread each weight image's 1st to 99th percentile to 0 .. 1
    #[arg(long, requires = "maps")]
    stretch: bool,
    /// The .npy file to write
    #[arg(long, short)]
    output: PathBuf,
    /// Pixels of the patch; images are resampled to it
    #[arg(long, default_value = "80x80", value_name = "WxH")]
    size: Size,
    /// Pixels to a side of the window in which light is measured, odd
    #[arg(long, default_value_t = 25, value_name = "D")]
    window: u32,
    /// Distance of neighbouring pixels in mm
    #[arg(long, default_value_t = 0.5, value_name = "MM")]
    pitch: f64,
    /// Thickness of the slab in mm
    #[arg(long, default_value_t = 20.0, value_name = "MM")]
    thickness: f64,
    /// Refractive index, 1 to 4
    #[arg(long, default_value_t = 1.5, value_name = "INDEX")]
    eta: f64,
    /// What lies beyond the border; "repeat" makes built-in materials tileable
    #[arg(long, default_value = "clamp", value_name = "MODE")]
    addressing: AddressingArg,
    /// Seed of the pattern and of the noise
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Add shot noise and a sensor's floor: photons counted where all light of the lit pixel leaves
    #[arg(long, value_name = "PHOTONS", num_args = 0..=1, default_missing_value = "1e6")]
    noise: Option<f64>,
    /// Write 16-bit floats: half the size, three digits
    #[arg(long)]
    half: bool,
    /// Leave the two directions of each pair as they come; otherwise they get their mean, since light paths can be reversed
    #[arg(long)]
    one_way: bool,
    /// Divide the width of every voxel by this, to see that the result stays
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR")]
    refine: f64,
}

const MAPS_HELP: &str = "\
Maps, in one of two ways:
  --maps marble=rest --maps ketchup=veins.png     weights of measured materials (Jensen et al. 2001): an image's grey
                                                  value, a number, or what the others leave of 1
  --maps albedo=colour.jpg --maps mfp=1.5         diffuse albedo of an image, and mean free path in mm: one number,
                                                  three (1.5,1.0,0.6), or an image with its range (mfp.png:0.3:2.0)
Materials: apple chicken1 chicken2 cream ketchup marble potato skimmilk skin1 skin2 spectralon wholemilk.

Built-in materials are synthetic patterns of the same measured media; blue-wax has an invented pigment beside them. Nothing
here was measured as a patch.";

/// Built-in material by its name on a command line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneArg(pub Scene);

impl ValueEnum for SceneArg {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [SceneArg; Scene::ALL.len()] = {
            let mut all = [SceneArg(Scene::Onyx); Scene::ALL.len()];
            let mut k = 0;
            while k < all.len() {
                all[k] = SceneArg(Scene::ALL[k]);
                k += 1;
            }
            all
        };
        &ALL
    }

    fn to_possible_value(&self) -> Option<clap::builder::PossibleValue> {
        Some(clap::builder::PossibleValue::new(self.0.name()).help(self.0.description()))
    }
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    match (&args.other, &args.capture) {
        (Some(Other::Btf(args)), _) => btf::run(args),
        (None, Some(args)) => simulate_capture(args),
        (None, None) => Err(bad_request("what is to be simulated? Give --scene or --maps, or `btf`")),
    }
}

fn simulate_capture(args: &CaptureArgs) -> anyhow::Result<()> {
    let size = args.size.0.map(|side| side as usize);
    let (map, source) = match args.scene {
        Some(SceneArg(scene)) => (scene.map(size, args.addressing.into(), args.seed), json!({ "scene": scene.name() })),
        None => (read_maps(args, size)?, json!({ "maps": args.maps, "stretch": args.stretch })),
    };
    let request = Request {
        map: &map,
        source,
        addressing: args.addressing.into(),
        pitch_mm: args.pitch,
        window: args.window,
        thickness_mm: args.thickness,
        eta: args.eta,
        refine: args.refine,
        finish: Finish { one_way: args.one_way, sensor: args.noise.map(|photons| Sensor { photons, seed: args.seed }) },
        seed: args.seed,
        scalar: if args.half { Scalar::F16 } else { Scalar::F32 },
    };
    request.check()?;
    check_target(&args.output)?;
    if args.output.extension().is_some_and(|extension| extension == "json") {
        let output = args.output.display();
        return Err(bad_request(format!("{output}: .json is for the facts beside the array; name the array .npy")));
    }
    let start = Instant::now();
    let Summary { window_share, asymmetry } = request.write(&args.output)?;
    let bytes = std::fs::metadata(&args.output).map_or(0, |metadata| metadata.len());
    outln!(
        "{}: synthetic capture, {} × {} pixels, window {}, {} in {:.1} s",
        args.output.display(),
        size[0],
        size[1],
        args.window,
        human(bytes),
        start.elapsed().as_secs_f64(),
    );
    outln!("{:.1} % of the light that leaves the surface leaves within the window", 100.0 * window_share);
    if window_share < 0.9 {
        outln!("the rest is lost to everything made from this capture: a larger --window or --pitch keeps more");
    }
    let end = if args.one_way { ", and stay so" } else { "; each has their mean" };
    outln!("the two directions of a pair came out {:.1} % apart on average{end}", 100.0 * asymmetry.exp_m1());
    Ok(())
}

/// How much finer or coarser than usual voxels may be.
const REFINE: RangeInclusive<f64> = 0.1..=16.0;
/// Voxels around a pixel, at most: each takes some 200 bytes on every core.
const MAX_VOXELS: usize = 8_000_000;

/// A capture to be simulated and written.
pub struct Request<'a> {
    /// Media of the patch, pixel by pixel.
    pub map: &'a MediumMap,
    /// Where the media come from, for the sidecar.
    pub source: Value,
    /// What lies beyond the border of the patch.
    pub addressing: Addressing,
    /// Distance of neighbouring pixels in mm.
    pub pitch_mm: f64,
    /// Pixels to a side of the window in which light is measured, odd.
    pub window: u32,
    /// Thickness of the slab in mm.
    pub thickness_mm: f64,
    /// Refractive index, 1 to 4.
    pub eta: f64,
    /// Divisor of the width of every voxel.
    pub refine: f64,
    /// Reciprocity and noise.
    pub finish: Finish,
    /// Seed of the pattern.
    pub seed: u64,
    /// Type of the numbers in the file.
    pub scalar: Scalar,
}

impl Request<'_> {
    /// Refuses what cannot be simulated.
    pub fn check(&self) -> anyhow::Result<()> {
        let positive = |what: &str, value: f64| {
            let fine = value.is_finite() && value > 0.0;
            fine.then_some(()).ok_or_else(|| bad_request(format!("{what} is {value}; it must be positive")))
        };
        positive("--pitch", self.pitch_mm)?;
        positive("--thickness", self.thickness_mm)?;
        let [shortest, longest] = LENGTHS_MM.map(f64::from);
        if !(shortest..=longest).contains(&self.pitch_mm) {
            return Err(bad_request(format!("--pitch is {} mm; from {shortest} to {longest} will do", self.pitch_mm)));
        }
        if !REFINE.contains(&self.refine) {
            let (least, most) = (REFINE.start(), REFINE.end());
            return Err(bad_request(format!("--refine is {}; it may be {least} to {most}", self.refine)));
        }
        positive("--noise", self.finish.sensor.map_or(1.0, |sensor| sensor.photons))?;
        if !(1.0..=4.0).contains(&self.eta) {
            return Err(bad_request(format!("--eta is {}; refractive indices are 1 to 4", self.eta)));
        }
        if self.window.is_multiple_of(2) || self.window > 2_047 {
            return Err(bad_request(format!("--window is {}; it must be odd and at most 2047", self.window)));
        }
        if self.map.size.iter().any(|side| *side > 65_535) {
            return Err(bad_request(format!("--size is {:?}; the limit is 65535 pixels", self.map.size)));
        }
        let voxels = self.slab().voxels();
        if voxels > MAX_VOXELS {
            return Err(bad_request(format!(
                "this takes {voxels} voxels around every pixel, more than {MAX_VOXELS}: a smaller --window or --refine \
                 takes fewer, and so does a --pitch nearer to the mean free path of light"
            )));
        }
        Ok(())
    }

    fn slab(&self) -> Slab<'_> {
        Slab {
            map: self.map,
            addressing: self.addressing,
            pitch_mm: self.pitch_mm,
            radius: self.window as usize / 2,
            thickness_mm: self.thickness_mm,
            eta: self.eta,
            refine: self.refine,
        }
    }

    /// Simulates and writes array and sidecar.
    pub fn write(&self, path: &Path) -> anyhow::Result<Summary> {
        let slab = self.slab();
        let radius = slab.radius;
        let sidecar = self.sidecar();
        let writer = CaptureWriter { path, size: self.map.size, radius, scalar: self.scalar, sidecar: &sidecar };
        Ok(simulate(&slab, &self.finish, &writer, &Bars::new())?)
    }

    /// Facts that stand beside the array.
    #[allow(clippy::cast_possible_truncation, reason = "lengths and indices need no more than f32")]
    pub fn sidecar(&self) -> Sidecar {
        let simulated = json!({
            "by": concat!("subsurf ", env!("CARGO_PKG_VERSION")),
            "source": self.source,
            "thickness_mm": self.thickness_mm,
            "seed": self.seed,
            "reciprocal": !self.finish.one_way,
            "photons": self.finish.sensor.map(|sensor| sensor.photons),
            "refine": self.refine,
        });
        Sidecar {
            pitch_mm: self.pitch_mm as f32,
            addressing: self.addressing,
            eta: self.eta as f32,
            simulated: Some(simulated),
        }
    }
}

/// Makes sense of `--maps`.
fn read_maps(args: &CaptureArgs, size: [usize; 2]) -> anyhow::Result<MediumMap> {
    let mut weights = Vec::new();
    let mut albedo = None;
    let mut mean_free_path = None;
    for entry in &args.maps {
        let (name, value) = entry.split_once('=').ok_or_else(|| {
            bad_request(format!("--maps {entry}: expected NAME=VALUE, for example marble=rest or albedo=colour.png"))
        })?;
        match name {
            "albedo" => albedo = Some(PathBuf::from(value)),
            "mfp" => mean_free_path = Some(parse_mean_free_path(value)?),
            name => weights.push((name.to_owned(), parse_weight(value))),
        }
    }
    match (albedo, mean_free_path, weights.is_empty()) {
        (Some(albedo), Some(length), true) => Ok(maps::albedo(&albedo, &length, size, args.eta)?),
        (None, None, false) => Ok(maps::mixture(&weights, size, args.stretch)?),
        (Some(_), None, true) => {
            Err(bad_request("--maps albedo=.. needs --maps mfp=.. too: how far light travels, in mm"))
        }
        (None, Some(_), true) => Err(bad_request("--maps mfp=.. needs --maps albedo=IMAGE too")),
        _ => Err(bad_request("--maps takes either measured materials or albedo and mfp, not both")),
    }
}

fn parse_weight(value: &str) -> Weight {
    match value.parse() {
        Ok(number) => Weight::Constant(number),
        Err(_) if value == "rest" => Weight::Rest,
        Err(_) => Weight::Image(value.into()),
    }
}

fn parse_mean_free_path(value: &str) -> anyhow::Result<MeanFreePath> {
    let numbers = |text: &str, separator: char| -> Option<Vec<f64>> {
        text.split(separator).map(|number| number.trim().parse().ok()).collect()
    };
    if let Some(lengths) = numbers(value, ',') {
        return match lengths[..] {
            [all] => Ok(MeanFreePath::Constant([all; 3])),
            [r, g, b] => Ok(MeanFreePath::Constant([r, g, b])),
            _ => Err(bad_request(format!("--maps mfp={value}: one length in mm, or three for red, green and blue"))),
        };
    }
    // IMAGE:FROM:TO, split from the end: a path may have colons.
    let mut parts = value.rsplitn(3, ':');
    if let (Some(to), Some(from), Some(path)) = (parts.next(), parts.next(), parts.next())
        && let (Ok(from), Ok(to)) = (from.parse(), to.parse())
    {
        return Ok(MeanFreePath::Image(path.into(), [from, to]));
    }
    Err(bad_request(format!("--maps mfp={value}: a length in mm, three of them, or IMAGE:FROM:TO with two lengths")))
}
