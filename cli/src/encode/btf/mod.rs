//! `subsurf encode btf`: from images of rough surfaces to a file.

mod report;

use std::path::PathBuf;
use std::time::Instant;

use clap::ValueEnum;
use subsurf_encoder::btf::nested::Extent;
use subsurf_encoder::btf::{Goal, Method, Options, Size, encode};
use subsurf_encoder::capture::{Images, load_btf};
use subsurf_encoder::metrics::btf::judge;
use subsurf_encoder::rate::Target;
use subsurf_encoder::{Error, check_target, write_bytes};

use crate::metadata::MetaArgs;
use crate::options::ByteCount;
use crate::outln;
use crate::program::failure::bad_request;
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;
use crate::program::threads;
use report::{Report, line};

/// How a file is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum MethodArg {
    /// Nested codebooks by shape-gain k-means from the top down, chosen anew from the bottom up against what is decoded;
    /// further stages add what is left. Drawn as they stand in the file, on the GPU too
    Nested,
    /// Texels of residual codewords times a Tucker-coded angular basis: the fewest bytes for a quality; expanded to 1 to
    /// 4 MB when loaded
    Factored,
    /// Nested codebooks by pruning, as Havran et al. make them: to compare with
    Havran2010,
}

impl From<MethodArg> for Method {
    fn from(arg: MethodArg) -> Self {
        match arg {
            MethodArg::Nested => Self::Nested,
            MethodArg::Factored => Self::Factored,
            MethodArg::Havran2010 => Self::Havran2010,
        }
    }
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
    /// BTFs: folders of images named "tl030 pl060 tv045 pv120.png" (.jpg, .exr, .hdr), in subfolders as well, .btf files of
    /// UBO2014, or isotropic BRDFs of MERL (.binary) or RGL (.bsdf)
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
    /// Distance of neighbouring texels in mm, 0.000001 to 1000000, for who draws the file in its true size
    #[arg(long, value_name = "MM")]
    texel_mm: Option<f32>,
    #[command(flatten)]
    meta: MetaArgs,
    /// Seed of the first codewords
    #[arg(long, default_value_t = 1)]
    seed: u64,
    /// Threads to use, at most eight for each core; the file is the same for any number
    #[arg(long)]
    threads: Option<usize>,
    /// Report as JSON
    #[arg(long)]
    json: bool,
}

pub(super) fn run(args: &Args) -> anyhow::Result<()> {
    threads::set(args.threads)?;
    let first = &args.inputs[0];
    let output = args.output.clone().unwrap_or_else(|| first.with_extension("subsurf"));
    check_target(&output)?;
    let start = Instant::now();
    let bars = Bars::new();
    let materials: Vec<Images> =
        args.inputs.iter().map(|path| load_btf(path, &bars)).collect::<subsurf_encoder::Result<_>>()?;
    let options = args.options()?;
    let graceful = Graceful::new();
    let mut encoded = encode(&materials, &args.names(), &options, &bars, &mut |point| {
        if !args.json {
            outln!("{}", line(point));
        }
    })
    .map_err(|error| args.meta.explain(error, args.target_bytes.is_some()))?;
    drop(graceful);
    encoded.bytes = args.meta.added_to(encoded.bytes)?;
    write_bytes(&output, &encoded.bytes)?;
    let seconds = start.elapsed().as_secs_f64();
    let error = match &encoded.curve {
        Some(curve) => curve.chosen().distortion,
        None => judge(&materials, &encoded.bytes, &bars).map_err(|source| Error::OwnOutput { source })?,
    };
    drop(bars);
    let raw_bytes = materials.iter().map(Images::bytes).sum();
    let report = Report { output: &output, encoded: &encoded, raw_bytes, seconds, error };
    if args.json {
        report.json()
    } else {
        report.print()
    }
    Ok(())
}

impl Args {
    fn options(&self) -> anyhow::Result<Options> {
        let method = self.method.into();
        let nodes = match self.nodes.as_deref() {
            Some(&[n_alpha, n_beta, n_theta, n_phi]) => Some([n_alpha, n_beta, n_theta, n_phi]),
            Some(nodes) => {
                return Err(bad_request(format!("--nodes has {} numbers, not four: 11,11,6,16", nodes.len())));
            }
            None => None,
        };
        let goal = match (self.target()?, method) {
            (Some(target), _) => Goal::Target(target),
            (None, Method::Nested) => Goal::Size(Size::Nested(Extent { p4: self.p4.max(1), stages: self.stages })),
            (None, _) => Goal::Usual,
        };
        Ok(Options { method, nodes, has_mipmaps: self.mipmaps, seed: self.seed, goal, texel_mm: self.texel_mm })
    }

    fn target(&self) -> anyhow::Result<Option<Target>> {
        let target = self.target_ssim.map(Target::Quality).or(self.target_bytes.map(|size| Target::Bytes(size.0)));
        target.map(|target| self.meta.leave_room(target)).transpose()
    }

    /// Names of the materials: those of their folders or files.
    fn names(&self) -> Vec<String> {
        let name =
            |path: &PathBuf| path.file_stem().map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
        self.inputs.iter().map(name).collect()
    }
}
