//! `subsurf simulate` of a capture.

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use serde_json::json;
use subsurf_encoder::capture::{Scalar, check_capture_target};
use subsurf_encoder::simulate::diffusion::{BuiltinMaterial, Finish, Method, Request, Sensor, Summary, check_patch};
use subsurf_encoder::simulate::monte_carlo::voxels::PACKETS;
use subsurf_viewer::human;

use super::maps;
use crate::options::{AddressingArg, Size};
use crate::outln;
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;

/// Arguments of a simulated capture.
#[derive(clap::Args)]
pub(super) struct SlabArgs {
    /// A built-in material
    #[arg(long, value_enum, conflicts_with = "maps", required_unless_present = "maps")]
    material: Option<MaterialArg>,
    /// Your own images: NAME=VALUE, once for each; see below
    #[arg(long, value_name = "NAME=VALUE")]
    maps: Vec<String>,
    /// Spread each weight image's 1st to 99th percentile to 0 .. 1
    #[arg(long, requires = "maps")]
    stretch: bool,
    /// The .npy file to write
    #[arg(long, short)]
    output: PathBuf,
    /// Diffusion, without noise and wrong near the beam; or photon by photon. Ctrl-C once writes what was traced so far
    #[arg(long, value_enum, default_value = "diffusion")]
    method: MethodArg,
    /// Photon packets for each pixel and channel of --method monte-carlo
    #[arg(long, default_value_t = PACKETS)]
    photons: u64,
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
    /// Seed of the pattern, of photons and of noise
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
    /// Divide the width of every voxel of diffusion by this, to see that the result stays
    #[arg(long, default_value_t = 1.0, value_name = "FACTOR")]
    refine: f64,
}

/// A method by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodArg {
    Diffusion,
    MonteCarlo,
}

/// A built-in material by name.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MaterialArg(pub BuiltinMaterial);

impl ValueEnum for MaterialArg {
    fn value_variants<'a>() -> &'a [Self] {
        const ALL: [MaterialArg; BuiltinMaterial::ALL.len()] = {
            let mut all = [MaterialArg(BuiltinMaterial::Onyx); BuiltinMaterial::ALL.len()];
            let mut k = 0;
            while k < all.len() {
                all[k] = MaterialArg(BuiltinMaterial::ALL[k]);
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

pub(super) fn run(args: &SlabArgs) -> anyhow::Result<()> {
    let bars = Bars::new();
    let size = args.size.0.map(|side| side as usize);
    check_patch(size, args.window, &args.output)?;
    check_capture_target(&args.output)?;
    let (map, source) = match args.material {
        Some(MaterialArg(material)) => {
            (material.map(size, args.addressing.into(), args.seed), json!({ "scene": material.name() }))
        }
        None => {
            let map = maps::read(&args.maps, args.stretch, size, args.eta, &bars)?;
            (map, json!({ "maps": args.maps, "stretch": args.stretch }))
        }
    };
    let method = match args.method {
        MethodArg::Diffusion => Method::Diffusion,
        MethodArg::MonteCarlo => Method::MonteCarlo { packets: args.photons },
    };
    let request = Request {
        method,
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
    let start = Instant::now();
    let Summary { window_share, asymmetry } = {
        let _graceful = matches!(method, Method::MonteCarlo { .. }).then(Graceful::new);
        request.write(&args.output, &bars)?
    };
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
