//! `subsurf encode`: from a capture to a file.

pub mod btf;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use serde_json::json;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Coding;
use subsurf_decoder::bssrdf::layout::MAX_BASE_MATERIALS;
use subsurf_encoder::bssrdf::{self, Encoded, Method, Options, fit_bytes};
use subsurf_encoder::capture::{Capture, sidecar_path};
use subsurf_encoder::rate::{self, Point, Target, Walked};
use subsurf_encoder::{check_target, write_bytes};

use crate::compare::{Judgement, judge};
use crate::curve;
use crate::options::{ByteCount, CaptureArgs};
use crate::outln;
use crate::program::failure::bad_request;
use crate::program::interrupt::Graceful;
use crate::program::memory::{available, resident};
use crate::program::progress::Bars;
use subsurf_viewer::human;

/// Fit a material to a capture and write a .subsurf file; `encode btf` does so with the images of a BTF.
///
/// Ctrl-C ends the fit early and writes the best model so far; once more ends the program.
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    other: Option<Other>,
    #[command(flatten)]
    capture: CaptureFit,
}

/// What is encoded but captures.
#[derive(clap::Subcommand)]
enum Other {
    Btf(btf::Args),
}

#[derive(clap::Args)]
struct CaptureFit {
    /// The capture: a .npy array of shape (height, width, D, D, 3) of Rd in mm⁻², and its sidecar .json with the pixel pitch
    #[arg(required = true)]
    capture: Option<PathBuf>,
    /// The .subsurf file to write; NAME.subsurf beside the capture if not given
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
    /// Nodes of a profile; half the window's width and one if not given
    #[arg(long, short = 'S', value_name = "S")]
    samples: Option<usize>,
    /// Seed of the first cluster centres
    #[arg(long, default_value_t = 1)]
    seed: u64,
    #[command(flatten)]
    facts: CaptureArgs,
    /// Threads to use; the file is the same for any number
    #[arg(long)]
    threads: Option<usize>,
    /// Memory that the fit may take besides the mapped capture, 2GB for example; what is free if not given
    #[arg(long, value_name = "SIZE")]
    max_memory: Option<ByteCount>,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

/// What a target chooses.
const CHOSEN: [&str; 5] = ["method", "per_pixel", "base_materials", "coding", "half_profiles"];

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum MethodArg {
    /// K-BMPP: K of M base materials per pixel (Yatagawa et al. 2020), fitted by alternation of exact steps
    Direct,
    /// K-BMPP as Yatagawa et al. fit it: L-BFGS-B and PatchMatch from a random start. A baseline, slow
    Paper,
    /// A profile for every pixel (Song et al. 2009): some thirty times larger
    Lsp,
    /// One of M clusters of those profiles per pixel: what K-BMPP is measured against
    Clusters,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub(crate) enum CodingArg {
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
            MethodArg::Paper => Self::Paper,
            MethodArg::Lsp => Self::Lsp,
            MethodArg::Clusters => Self::Clusters,
        }
    }
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    match (&args.other, &args.capture.capture) {
        (Some(Other::Btf(args)), _) => btf::run(args),
        (None, Some(path)) => encode_capture(path, &args.capture),
        (None, None) => Err(bad_request("what is to be encoded? Give a capture, or `btf` and its images")),
    }
}

fn set_threads(threads: usize) -> anyhow::Result<()> {
    if threads == 0 {
        return Err(bad_request("--threads is 0; leave it out to use all of them"));
    }
    rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    Ok(())
}

fn encode_capture(path: &Path, args: &CaptureFit) -> anyhow::Result<()> {
    if let Some(threads) = args.threads {
        set_threads(threads)?;
    }
    let capture = Capture::open(path, &args.facts.overrides())?;
    let output = args.output.clone().unwrap_or_else(|| path.with_extension("subsurf"));
    check_target(&output)?;
    for input in [path.to_owned(), sidecar_path(path)] {
        if is_same_file(&output, &input) {
            return Err(bad_request(format!("{}: would overwrite {}", output.display(), input.display())));
        }
    }
    let options = Options {
        method: args.method.into(),
        per_pixel: args.per_pixel,
        coding: args.coding.into(),
        half_profiles: args.half_profiles,
        base_materials: args.base_materials,
        seed: args.seed,
    };
    check_memory(args, &capture, &options)?;
    let start = Instant::now();
    let graceful = Graceful::new();
    let target = args.target_psnr.map(Target::PsnrDb).or(args.target_bytes.map(|size| Target::Bytes(size.0)));
    let (encoded, options, walked) = if let Some(target) = target {
        let walked = walk(&capture, args, target)?;
        let best = &walked.points[walked.best];
        write_bytes(&output, &best.encoded.bytes)?;
        (Encoded { stopped: walked.stopped, ..best.encoded.clone() }, best.options, Some(walked))
    } else {
        (encode(&capture, args.samples, &options, &output)?, options, None)
    };
    drop(graceful);
    let seconds = start.elapsed().as_secs_f64();
    let material = Bssrdf::parse(&encoded.bytes).map_err(subsurf_runtime::Error::Read)?;
    let judgement = judge(&capture, &material, encoded.bytes.len() as u64, &Bars::new())?;
    let report = Report { capture: &capture, output: &output, options: &options, encoded: &encoded, seconds };
    if args.json {
        report.print_json(&judgement, walked.as_ref())
    } else {
        report.print(&judgement, walked.as_ref())
    }
    Ok(())
}

/// Refuses what the machine's memory does not hold, before it is tried.
fn check_memory(args: &CaptureFit, capture: &Capture, options: &Options) -> anyhow::Result<()> {
    let targeted = args.target_psnr.is_some() || args.target_bytes.is_some();
    // A target may lead to the most base materials there can be.
    let base_materials = if targeted { MAX_BASE_MATERIALS as usize } else { options.base_materials };
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

/// Fits, reads what came of it, and writes.
pub(crate) fn encode(
    capture: &Capture,
    samples: Option<usize>,
    options: &Options,
    output: &Path,
) -> anyhow::Result<Encoded> {
    let encoded = bssrdf::encode(capture, samples, options, &Bars::new())?;
    Bssrdf::parse(&encoded.bytes).map_err(subsurf_runtime::Error::Read)?;
    write_bytes(output, &encoded.bytes)?;
    Ok(encoded)
}

struct Report<'a> {
    capture: &'a Capture,
    output: &'a Path,
    options: &'a Options,
    encoded: &'a Encoded,
    seconds: f64,
}

impl Report<'_> {
    fn print_json(&self, judgement: &Judgement, walked: Option<&Walked>) {
        let memory = resident().unwrap_or_default();
        let encoded = self.encoded;
        let mut value = json!({
            "file": self.output,
            "method": format!("{:?}", self.options.method).to_lowercase(),
            "per_pixel": encoded.per_pixel,
            "coding": coding_name(self.options.coding),
            "half_profiles": self.options.half_profiles,
            "base_materials": encoded.base_materials,
            "samples": encoded.samples,
            "cost": encoded.cost,
            "entries": encoded.entries,
            "measured": encoded.measured,
            "stopped": encoded.stopped,
            "seconds": self.seconds,
            "peak_rss_bytes": memory.peak,
            "peak_rss_beside_mapped_bytes": memory.peak.saturating_sub(memory.mapped),
        });
        if let (Some(value), Some(judgement)) = (value.as_object_mut(), judgement.to_json().as_object()) {
            value.extend(judgement.clone());
            if let Some(walked) = walked {
                value.insert("curve".to_owned(), curve::to_json(walked));
            }
        }
        outln!("{value:#}");
    }

    fn print(&self, judgement: &Judgement, walked: Option<&Walked>) {
        let encoded = self.encoded;
        if let Some(walked) = walked {
            curve::print(walked);
        }
        let size = human(encoded.bytes.len() as u64);
        outln!("{}: {size} from {}", self.output.display(), human(self.capture.file_bytes()));
        if encoded.stopped {
            outln!("  interrupted: this is the best model so far");
        }
        let missing = encoded.entries - encoded.measured;
        if missing > 0 {
            #[allow(clippy::cast_precision_loss, reason = "a percentage")]
            let share = 100.0 * missing as f64 / encoded.entries as f64;
            outln!("  {share:.1} % of the entries inside the material were not measured; they weigh nothing");
        }
        if encoded.per_pixel > 0 && encoded.base_materials < self.options.base_materials {
            let asked = self.options.base_materials;
            outln!("  {} of {asked} base materials: no pixel had use for the others", encoded.base_materials);
        }
        judgement.print();
        let memory = resident().unwrap_or_default();
        let beside_mapped = human(memory.peak.saturating_sub(memory.mapped));
        outln!("  {:.1} s, {beside_mapped} of memory besides the mapped capture", self.seconds);
    }
}

/// Tries models, and says what came of each.
fn walk(capture: &Capture, args: &CaptureFit, target: Target) -> anyhow::Result<Walked> {
    let mut said = |point: &Point| {
        if !args.json {
            outln!("{}", curve::line(point));
        }
    };
    Ok(rate::walk(capture, args.samples, args.seed, target, &Bars::new(), &mut said)?)
}

/// As on the command line.
pub(crate) fn coding_name(coding: Coding) -> &'static str {
    match coding {
        Coding::Exact => "exact",
        Coding::SmallRatios => "small",
        Coding::Palette => "palette",
    }
}
