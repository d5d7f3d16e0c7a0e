//! `subsurf encode btf`: from images of rough surfaces to a file.

mod methods;
mod report;

use std::path::{Path, PathBuf};
use std::time::Instant;

use clap::ValueEnum;
use subsurf_decoder::btf::Grid;
use subsurf_encoder::btf::nested::Extent;
use subsurf_encoder::btf::rate::{self, Target};
use subsurf_encoder::btf::{Folder, Images, Merl, Source, Ubo};
use subsurf_encoder::{check_target, write_bytes};

use crate::options::ByteCount;
use crate::program::failure::bad_request;
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;
pub use methods::{Common, Encoded, detail, usual_bytes};
use report::Report;

/// How a file is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum MethodArg {
    /// Nested codebooks by shape-gain k-means from the top down, chosen anew from the bottom up against what is decoded;
    /// further stages add what is left. Drawn as they stand in the file, on the GPU too
    Nested,
    /// Texels of residual codewords times a Tucker-coded angular basis: the fewest bytes for a quality; expanded to 1 to
    /// 4 MB when loaded
    Factored,
    /// Nested codebooks by pruning, as the paper does: to compare with
    Paper,
}

/// Compress BTFs, one or several, into one .subsurf file.
///
/// Luma and chroma of every texel's apparent BRDF are vector-quantised level by level: by the view's azimuth, its angle
/// from the normal, and the light's two angles (Havran, Filip and Myszkowski 2010). Several materials share their
/// codebooks, which takes fewer bytes than a file for each.
///
/// Nested codebooks of the usual size come to some 1:3000 at 128 × 128 texels, factors to 1:1000.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// BTFs: folders of images named "tl030 pl060 tv045 pv120.png" (.jpg, .exr, .hdr), .btf files of UBO2014, or
    /// isotropic BRDFs of MERL (.binary)
    #[arg(required = true, value_name = "BTF")]
    inputs: Vec<PathBuf>,
    /// The .subsurf file to write; NAME.subsurf beside the first BTF if not given
    #[arg(long, short)]
    output: Option<PathBuf>,
    /// How to make it
    #[arg(long, value_enum, default_value = "nested")]
    method: MethodArg,
    /// Choose sizes: the smallest file with this mean structural similarity of Y, Cr and Cb, 0 to 1
    #[arg(long, value_name = "SSIM", conflicts_with_all = ["target_bytes", "p4", "stages"])]
    target_ssim: Option<f64>,
    /// Choose sizes: the best file of at most this size; 200000, 200kB
    #[arg(long, value_name = "SIZE", conflicts_with_all = ["p4", "stages"])]
    target_bytes: Option<ByteCount>,
    /// Entries of P4, whole apparent BRDFs; P3 and P2 have twice as many (nested)
    #[arg(long, default_value_t = Extent::USUAL.p4, value_name = "N")]
    p4: usize,
    /// Additive stages of codebooks, 1 to 4 (nested)
    #[arg(long, default_value_t = Extent::USUAL.stages, value_name = "N")]
    stages: usize,
    /// Nodes of α, sin β, θ_v and φ_v, each 2 to 64, or 1 of φ_v; 11,11,6,16, with 24 of φ_v for factors, and
    /// 45,45,18,1 for isotropic BRDFs
    #[arg(long, value_delimiter = ',', value_name = "NODES")]
    nodes: Option<Vec<u8>>,
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

/// If there are images of a BTF, or one may expect some.
pub(crate) fn is_btf(path: &Path) -> bool {
    path.is_dir() || matches!(extension(path).as_deref(), Some("btf" | "binary"))
}

fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}

/// Reads all images of a BTF.
pub fn load(path: &Path) -> anyhow::Result<Images> {
    match extension(path).as_deref() {
        Some("btf") => Ok(load_from(&Ubo::open(path)?)?),
        Some("binary") => Ok(load_from(&Merl::open(path)?)?),
        _ => Ok(load_from(&Folder::open(path)?)?),
    }
}

fn load_from(source: &impl Source) -> subsurf_encoder::Result<Images> {
    Images::load(source, &Bars::new())
}

/// Nodes where none are asked for.
pub fn usual_nodes(method: MethodArg, images: &Images) -> [u8; 4] {
    let is_isotropic = images.views().iter().all(|view| view.y == 0.0);
    match method {
        _ if is_isotropic => [45, 45, 18, 1],
        MethodArg::Factored => [11, 11, 6, 24],
        MethodArg::Nested | MethodArg::Paper => [11, 11, 6, 16],
    }
}

/// A grid that reaches as far as what was measured, and no farther.
pub fn grid(images: &Images, nodes: &[u8]) -> anyhow::Result<Grid> {
    let [n_alpha, n_beta, n_theta, n_phi] = nodes else {
        return Err(bad_request(format!("--nodes has {} numbers, not four: 11,11,6,16", nodes.len())));
    };
    if nodes.iter().any(|nodes| !(1..=64).contains(nodes)) || [n_alpha, n_beta, n_theta].contains(&&1) {
        return Err(bad_request("--nodes are from 2 to 64 each, those of φ_v from 1"));
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
    let nodes = args.nodes.clone().unwrap_or_else(|| usual_nodes(args.method, &materials[0]).to_vec());
    let grid = grid(&materials[0], &nodes)?;
    let common = Common { grid, names: args.names(), has_mipmaps: args.mipmaps, seed: args.seed };
    let graceful = Graceful::new();
    let made = match args.method {
        MethodArg::Nested => methods::nested(args, &materials, common),
        MethodArg::Factored => methods::factored(args, &materials, common),
        MethodArg::Paper => methods::paper(args, &materials, &common),
    }?;
    drop(graceful);
    write_bytes(&output, &made.bytes)?;
    let report = Report {
        output: &output,
        made: &made,
        raw_bytes: materials.iter().map(Images::bytes).sum(),
        seconds: start.elapsed().as_secs_f64(),
        error: match &made.walked {
            Some(walked) => walked.points[walked.best].error,
            None => rate::judge(&materials, &made.bytes, &Bars::new()),
        },
    };
    if args.json {
        report.json()
    } else {
        report.print()
    }
    Ok(())
}

impl Args {
    fn target(&self) -> Option<Target> {
        self.target_ssim.map(Target::Ssim).or(self.target_bytes.map(|size| Target::Bytes(size.0)))
    }

    /// Names of the materials: those of their folders or files.
    fn names(&self) -> Vec<String> {
        let name =
            |path: &PathBuf| path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        self.inputs.iter().map(name).collect()
    }
}
