//! `subsurf encode` of a capture.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Coding;
use subsurf_decoder::bssrdf::layout::MAX_BASE_MATERIALS;
use subsurf_encoder::bssrdf::{Encoded, Method, Options, encode, fit_bytes};
use subsurf_encoder::capture::{Capture, sidecar_path};
use subsurf_encoder::memory::available;
use subsurf_encoder::metrics::bssrdf::judge;
use subsurf_encoder::rate::Target;
use subsurf_encoder::rate::bssrdf::{Point, search};
use subsurf_encoder::{check_target, write_bytes};
use subsurf_viewer::human;

use super::basis::{self, BasisArgs};
use super::curve;
use super::report::Report;
use crate::metadata::MetaArgs;
use crate::options::{ByteCount, CaptureArgs};
use crate::outln;
use crate::program::failure::bad_request;
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;
use crate::program::threads;

/// Arguments of a fit to a capture.
#[derive(clap::Args)]
pub(super) struct FitArgs {
    /// The capture: a .npy or .npz array of shape (height, width, D, D, 3) of Rd in mm⁻², and its sidecar .json with the pixel pitch
    #[arg(required_unless_present = "add_basis")]
    capture: Option<PathBuf>,
    /// The .subsurf file to write; NAME.subsurf beside the capture if not given, with --add-basis the file itself
    #[arg(long, short)]
    output: Option<PathBuf>,
    /// What to fit
    #[arg(long, value_enum, default_value = "direct")]
    method: MethodArg,
    /// Base materials per pixel: 1, 2, 3 or 5. A pixel takes 8 bits (16 if M > 256), 48, 120 or 200
    #[arg(long, short = 'K', default_value_t = 2, value_name = "K")]
    per_pixel: usize,
    /// Base materials, 1 to 256; to 65536 with one per pixel
    #[arg(long, short = 'M', default_value_t = 128, value_name = "M")]
    base_materials: usize,
    /// How two base materials per pixel are stored
    #[arg(long, value_enum, default_value = "exact")]
    coding: CodingArg,
    /// Store base profiles as half floats: half the size, an error of up to 0.4 % of Rd
    #[arg(long)]
    half_profiles: bool,
    /// Choose K, M and precision: the smallest file with this PSNR under uniform light, in dB
    #[arg(long, value_name = "DB", conflicts_with_all = CHOSEN)]
    target_psnr: Option<f64>,
    /// Choose K, M and precision: the best file of at most this size; 40000, 40kB
    #[arg(long, value_name = "SIZE", conflicts_with_all = CHOSEN, conflicts_with = "target_psnr")]
    target_bytes: Option<ByteCount>,
    #[command(flatten)]
    basis: BasisArgs,
    /// Nodes of a profile; half the window's width and one if not given
    #[arg(long, short = 'S', value_name = "S")]
    samples: Option<usize>,
    /// Seed of the first cluster centres
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    facts: CaptureArgs,
    #[command(flatten)]
    meta: MetaArgs,
    /// Threads to use, at most eight for each core; the file is the same for any number
    #[arg(long)]
    threads: Option<usize>,
    /// Memory that the fit may take besides the mapped capture, 2GB for example; what is free if not given
    #[arg(long, value_name = "SIZE")]
    max_memory: Option<ByteCount>,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

/// Arguments that a target stands for.
const CHOSEN: [&str; 5] = ["method", "per_pixel", "base_materials", "coding", "half_profiles"];

/// What is fitted, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodArg {
    /// K-BMPP: K of M base materials per pixel (Yatagawa et al. 2020), fitted by alternation of exact steps
    Direct,
    /// K-BMPP as Yatagawa et al. fit it: L-BFGS-B and PatchMatch from a random start. A baseline, slow
    Yatagawa2020,
    /// A profile for every pixel (Song et al. 2009): some thirty times larger
    Song2009,
    /// One of M clusters of those profiles per pixel: what K-BMPP is measured against
    Clusters,
}

/// Storage of ratios.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum CodingArg {
    /// 48 bits per pixel: ratios as floats
    Exact,
    /// 24 bits per pixel: ratios in 8 bits
    Small,
    /// 16 bits per pixel: one of at most 2,048 pairs, and a ratio in 5 bits
    Palette,
}

impl From<CodingArg> for Coding {
    fn from(arg: CodingArg) -> Self {
        match arg {
            CodingArg::Exact => Self::Exact,
            CodingArg::Small => Self::SmallRatios,
            CodingArg::Palette => Self::Palette,
        }
    }
}

impl From<MethodArg> for Method {
    fn from(arg: MethodArg) -> Self {
        match arg {
            MethodArg::Direct => Self::Direct,
            MethodArg::Yatagawa2020 => Self::Yatagawa2020,
            MethodArg::Song2009 => Self::Song2009,
            MethodArg::Clusters => Self::Clusters,
        }
    }
}

impl FitArgs {
    fn options(&self) -> Options {
        Options {
            method: self.method.into(),
            per_pixel: self.per_pixel,
            coding: self.coding.into(),
            half_profiles: self.half_profiles,
            base_materials: self.base_materials,
            seed: self.seed,
        }
    }

    fn target(&self) -> Option<Target> {
        self.target_psnr.map(Target::Quality).or(self.target_bytes.map(|size| Target::Bytes(size.0)))
    }
}

pub(super) fn run(args: &FitArgs) -> anyhow::Result<()> {
    threads::set(args.threads)?;
    if let Some(path) = &args.basis.add_basis {
        return basis::add(path, args.output.as_ref().unwrap_or(path), &args.basis, &args.meta, args.json);
    }
    let Some(path) = &args.capture else {
        return Err(bad_request("what is to be encoded? Give a capture, or `btf` and its images"));
    };
    let capture = args.facts.open(path)?;
    let output = args.output.clone().unwrap_or_else(|| path.with_extension("subsurf"));
    check_target(&output)?;
    for input in [path.to_owned(), sidecar_path(path)] {
        if is_same_file(&output, &input) {
            return Err(bad_request(format!("{}: would overwrite {}", output.display(), input.display())));
        }
    }
    let options = args.options();
    check_memory(args, &capture, &options)?;
    let start = Instant::now();
    let graceful = Graceful::new();
    let bars = Bars::new();
    let (encoded, options, curve) = if let Some(target) = args.target() {
        let mut found = |point: &Point| {
            if !args.json {
                outln!("{}", curve::line(point));
            }
        };
        let target = args.meta.leave_room(target)?;
        let (target, kept) = args.basis.leave_room(target, &capture, args.samples)?;
        let curve = search(&capture, args.samples, args.seed, target, &bars, &mut found).map_err(|error| {
            if kept == 0 || !error.is_callers() {
                return args.meta.explain(error, args.target_bytes.is_some());
            }
            bad_request(format!("{error}; {kept} bytes are kept for the separable basis, which --no-basis leaves out"))
        })?;
        let best = curve.chosen();
        (Encoded { stopped: curve.stopped, ..best.file.clone() }, best.candidate, Some(curve))
    } else {
        (encode(&capture, args.samples, &options, &bars)?, options, None)
    };
    let encoded = args.basis.added_to(encoded, &bars)?;
    let encoded = Encoded { bytes: args.meta.added_to(encoded.bytes)?, ..encoded };
    write_bytes(&output, &encoded.bytes)?;
    drop(graceful);
    let seconds = start.elapsed().as_secs_f64();
    let material = Bssrdf::parse(&encoded.bytes)?;
    let judgement = judge(&capture, &material, encoded.bytes.len() as u64, &bars)?;
    drop(bars);
    let basis = material.basis();
    let report = Report { capture: &capture, output: &output, options: &options, encoded: &encoded, seconds, basis };
    if args.json {
        report.print_json(&judgement, curve.as_ref())
    } else {
        report.print(&judgement, curve.as_ref())
    }
    Ok(())
}

/// Refuses what the machine's memory does not hold, before it is tried.
fn check_memory(args: &FitArgs, capture: &Capture, options: &Options) -> anyhow::Result<()> {
    // A target may lead to the most base materials there can be.
    let base_materials = if args.target().is_some() { MAX_BASE_MATERIALS as usize } else { options.base_materials };
    let needed = fit_bytes(capture, args.samples, &Options { base_materials, ..*options })?;
    let Some(limit) = args.max_memory.map(|size| size.0).or_else(available) else {
        return Ok(());
    };
    if needed > limit {
        let source = if args.max_memory.is_some() { "--max-memory allows" } else { "this machine has free" };
        return Err(bad_request(format!(
            "the fit may take {} of memory, and {source} {}: a smaller -S takes less; --max-memory overrides",
            human(needed),
            human(limit),
        )));
    }
    Ok(())
}

fn is_same_file(a: &Path, b: &Path) -> bool {
    a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}
