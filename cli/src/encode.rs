//! `subsurf encode`: from a capture to a file.

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use serde_json::json;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Coding;
use subsurf_encoder::bssrdf::{self, Encoded, Method, Options};
use subsurf_encoder::capture::{Capture, sidecar_path};
use subsurf_encoder::{check_target, write_bytes};

use crate::compare::{Judgement, judge};
use crate::failure::bad_request;
use crate::memory::{human, resident};
use crate::options::CaptureArgs;
use crate::progress::Bars;
use crate::say::say;

/// Fit a material to a capture and write a .subsurf file.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The capture: a .npy array of shape (height, width, D, D, 3) of Rd in mm⁻², and its sidecar .json with the pixel pitch
    capture: PathBuf,
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
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

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
    if let Some(threads) = args.threads {
        if threads == 0 {
            return Err(bad_request("--threads is 0; leave it out to use all of them"));
        }
        rayon::ThreadPoolBuilder::new().num_threads(threads).build_global()?;
    }
    let capture = Capture::open(&args.capture, &args.facts.overrides())?;
    let output = args.output.clone().unwrap_or_else(|| args.capture.with_extension("subsurf"));
    check_target(&output)?;
    for input in [args.capture.clone(), sidecar_path(&args.capture)] {
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
        samples: args.samples,
        seed: args.seed,
    };
    let start = Instant::now();
    let encoded = encode(&capture, &options, &output)?;
    let seconds = start.elapsed().as_secs_f64();
    let material = Bssrdf::parse(&encoded.bytes).map_err(subsurf_runtime::Error::Read)?;
    let judgement = judge(&capture, &material, encoded.bytes.len() as u64, &Bars::new())?;
    report(args, &capture, &output, &encoded, &judgement, seconds);
    Ok(())
}

fn is_same_file(a: &Path, b: &Path) -> bool {
    a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}

/// Fits, reads what came of it, and writes.
pub(crate) fn encode(capture: &Capture, options: &Options, output: &Path) -> anyhow::Result<Encoded> {
    let encoded = bssrdf::encode(capture, options, &Bars::new())?;
    Bssrdf::parse(&encoded.bytes).map_err(subsurf_runtime::Error::Read)?;
    write_bytes(output, &encoded.bytes)?;
    Ok(encoded)
}

fn report(args: &Args, capture: &Capture, output: &Path, encoded: &Encoded, judgement: &Judgement, seconds: f64) {
    let memory = resident().unwrap_or_default();
    let beside_mapped = memory.peak.saturating_sub(memory.mapped);
    if args.json {
        let mut value = json!({
            "file": output,
            "method": format!("{:?}", args.method).to_lowercase(),
            "per_pixel": encoded.per_pixel,
            "coding": format!("{:?}", args.coding).to_lowercase(),
            "base_materials": encoded.base_materials,
            "samples": encoded.samples,
            "cost": encoded.cost,
            "entries": encoded.entries,
            "measured": encoded.measured,
            "seconds": seconds,
            "peak_rss_bytes": memory.peak,
            "peak_rss_beside_mapped_bytes": beside_mapped,
        });
        if let (Some(value), Some(judgement)) = (value.as_object_mut(), judgement.to_json().as_object()) {
            value.extend(judgement.clone());
        }
        say!("{value:#}");
        return;
    }
    say!("{}: {} from {}", output.display(), human(encoded.bytes.len() as u64), human(capture.file_bytes()));
    let missing = encoded.entries - encoded.measured;
    if missing > 0 {
        #[allow(clippy::cast_precision_loss, reason = "a percentage")]
        let share = 100.0 * missing as f64 / encoded.entries as f64;
        say!("  {share:.1} % of the entries inside the material were not measured; they weigh nothing");
    }
    judgement.print();
    say!("  {seconds:.1} s, {} of memory besides the mapped capture", human(beside_mapped));
}
