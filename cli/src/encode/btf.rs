//! `subsurf encode btf`: from images of rough surfaces to a file.

use std::path::{Path, PathBuf};
use std::time::Instant;

use serde_json::json;
use subsurf_decoder::Btf;
use subsurf_decoder::btf::Grid;
use subsurf_encoder::btf::nested::{ChromaSizes, Options, Prepared};
use subsurf_encoder::btf::rate::{self, Point, Target, Walked};
use subsurf_encoder::btf::{Detail, Folder, Images, Source, Survey, Ubo};
use subsurf_encoder::metrics::btf::BtfError;
use subsurf_encoder::{check_target, write_bytes};

use crate::failure::bad_request;
use crate::interrupt::Graceful;
use crate::memory::{human, resident};
use crate::options::ByteCount;
use crate::progress::Bars;
use crate::say::say;

/// Compress BTFs, one or several, into one .subsurf file of nested codebooks.
///
/// Luma and chroma of every texel's apparent BRDF are vector-quantised level by level: by the view's azimuth, its angle
/// from the normal, and the light's two angles (Havran, Filip and Myszkowski 2010). Codebooks are made by shape-gain
/// k-means from the top down, then chosen anew from the bottom up against what is decoded; further stages add what is
/// left. Several materials share their codebooks, which takes fewer bytes than a file for each.
///
/// The usual 512 entries of P4 in one stage come to some 1:3000 at 128 × 128 texels.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// BTFs: folders of images named "tl030 pl060 tv045 pv120.png" (.jpg, .exr, .hdr), or .btf files of UBO2014
    #[arg(required = true, value_name = "BTF")]
    inputs: Vec<PathBuf>,
    /// The .subsurf file to write; NAME.subsurf beside the first BTF if not given
    #[arg(long, short)]
    output: Option<PathBuf>,
    /// Choose codebooks: the smallest file with this mean structural similarity of Y, Cr and Cb, 0 to 1
    #[arg(long, value_name = "SSIM", conflicts_with_all = ["target_bytes", "p4", "stages"])]
    target_ssim: Option<f64>,
    /// Choose codebooks: the best file of at most this size; 200000, 200kB
    #[arg(long, value_name = "SIZE", conflicts_with_all = ["p4", "stages"])]
    target_bytes: Option<ByteCount>,
    /// Entries of P4, whole apparent BRDFs; P3 and P2 have twice as many
    #[arg(long, default_value_t = 512, value_name = "N")]
    p4: usize,
    /// Additive stages of codebooks, 1 to 4
    #[arg(long, default_value_t = 1, value_name = "N")]
    stages: usize,
    /// Nodes of α, sin β, θ_v and φ_v, each 2 to 64
    #[arg(long, default_value = "11,11,6,16", value_delimiter = ',', value_name = "NODES")]
    nodes: Vec<u8>,
    /// Make mipmaps: a third more of what is stored for texels
    #[arg(long)]
    mipmaps: bool,
    /// Seed of the first codewords
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads to use; the file is the same for any number
    #[arg(long)]
    threads: Option<usize>,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

/// Components that codebooks are made from: more than any of them can hold.
const DETAIL: Detail = Detail { luma: 128, chroma: 16 };
const CHROMA: ChromaSizes = ChromaSizes { i2: 64, i1: 64, colours: 64, tints: 64 };

/// Reads all images of a BTF.
pub(crate) fn load(path: &Path) -> anyhow::Result<Images> {
    let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
    if extension.is_some_and(|extension| extension == "btf") {
        Ok(load_from(&Ubo::open(path)?)?)
    } else {
        Ok(load_from(&Folder::open(path)?)?)
    }
}

fn load_from(source: &impl Source) -> subsurf_encoder::Result<Images> {
    Images::load(source, &Bars::new())
}

/// A grid that reaches as far as what was measured, and no farther.
fn grid(images: &Images, nodes: &[u8]) -> anyhow::Result<Grid> {
    let [n_alpha, n_beta, n_theta, n_phi] = nodes else {
        return Err(bad_request(format!("--nodes has {} numbers, not four: 11,11,6,16", nodes.len())));
    };
    if nodes.iter().any(|nodes| !(2..=64).contains(nodes)) {
        return Err(bad_request("--nodes are from 2 to 64 each"));
    }
    let lowest = |directions: &[glam::Vec3]| directions.iter().map(|direction| direction.z).fold(1.0, f32::min);
    // A degree at least: a single direction has no reach.
    let light_max = lowest(images.lights()).clamp(0.0, 0.999_8).acos();
    let theta_max = lowest(images.views()).clamp(0.0, 0.999_8).acos();
    Ok(Grid {
        n_alpha: *n_alpha,
        n_beta: *n_beta,
        n_theta: *n_theta,
        n_phi: *n_phi,
        alpha_max: light_max,
        sin_beta_max: light_max.sin(),
        theta_max,
        cos_light_min: light_max.cos().clamp(0.0, 0.999),
    })
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if let Some(threads) = args.threads {
        super::set_threads(threads)?;
    }
    let first = &args.inputs[0];
    let output = args.output.clone().unwrap_or_else(|| first.with_extension("subsurf"));
    check_target(&output)?;
    let start = Instant::now();
    let materials: Vec<Images> = args.inputs.iter().map(|path| load(path)).collect::<anyhow::Result<_>>()?;
    let survey = Survey::new(&materials, DETAIL, args.seed, &Bars::new())?;
    let name = |path: &PathBuf| path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    let options = Options {
        grid: grid(&materials[0], &args.nodes)?,
        chroma: CHROMA,
        names: args.inputs.iter().map(name).collect(),
        has_mipmaps: args.mipmaps,
        seed: args.seed,
    };
    let prepared = Prepared::new(&materials, &survey, options);
    let target = args.target_ssim.map(Target::Ssim).or(args.target_bytes.map(|size| Target::Bytes(size.0)));
    let graceful = Graceful::new();
    let (bytes, walked) = if let Some(target) = target {
        let said = |point: &Point| {
            if !args.json {
                say!("{}", line(point));
            }
        };
        let walked = rate::walk(&materials, &prepared, target, &Bars::new(), said)?;
        (walked.points[walked.best].bytes.clone(), Some(walked))
    } else {
        let stages = rate::stages(args.p4.max(1), args.stages);
        (prepared.encode(&stages, &Bars::new())?.to_bytes(), None)
    };
    drop(graceful);
    Btf::parse(&bytes).map_err(subsurf_runtime::Error::Read)?;
    write_bytes(&output, &bytes)?;
    let seconds = start.elapsed().as_secs_f64();
    let error = rate::judge(&materials, &bytes, &Bars::new()).ok();
    report(args, &output, &bytes, survey.raw_bytes, error, walked.as_ref(), seconds);
    Ok(())
}

/// One file that was tried.
fn line(point: &Point) -> String {
    let [luma, cr, cb] = point.error.mssim;
    let p4 = point.stages.first().map_or(0, |sizes| sizes.p4);
    format!(
        "  {:>8}  P4 = {p4:<4} × {}  MSSIM {:.4} (Y {luma:.4}, Cr {cr:.4}, Cb {cb:.4})  PSNR {:.1} dB",
        human(point.bytes.len() as u64),
        point.stages.len(),
        point.error.mean_mssim(),
        point.error.psnr_db,
    )
}

fn report(
    args: &Args,
    output: &Path,
    bytes: &[u8],
    raw_bytes: u64,
    error: Option<BtfError>,
    walked: Option<&Walked>,
    seconds: f64,
) {
    let memory = resident().unwrap_or_default();
    if args.json {
        let of_error = |error: &BtfError| {
            let [luma, cr, cb] = error.mssim;
            json!({ "mssim": { "y": luma, "cr": cr, "cb": cb, "mean": error.mean_mssim() }, "psnr_db": error.psnr_db })
        };
        let points = walked.map(|walked| {
            let point = |(number, point): (usize, &Point)| {
                json!({
                    "chosen": number == walked.best, "bytes": point.bytes.len(), "error": of_error(&point.error),
                    "p4": point.stages.first().map(|sizes| sizes.p4), "stages": point.stages.len(),
                })
            };
            walked.points.iter().enumerate().map(point).collect::<Vec<_>>()
        });
        let value = json!({
            "file": output, "bytes": bytes.len(), "raw_bytes": raw_bytes, "error": error.as_ref().map(of_error),
            "curve": points, "seconds": seconds, "peak_rss_bytes": memory.peak,
        });
        say!("{value:#}");
        return;
    }
    #[allow(clippy::cast_precision_loss, reason = "a ratio for people")]
    let ratio = raw_bytes as f64 / bytes.len() as f64;
    say!("{}: {} from {}, 1:{ratio:.0}", output.display(), human(bytes.len() as u64), human(raw_bytes));
    if let Some(error) = error {
        let [luma, cr, cb] = error.mssim;
        say!(
            "  MSSIM {:.4} (Y {luma:.4}, Cr {cr:.4}, Cb {cb:.4}), PSNR {:.1} dB over {} pairs of directions",
            error.mean_mssim(),
            error.psnr_db,
            error.pairs
        );
    }
    say!("  {seconds:.1} s, {} of memory", human(memory.peak));
}
