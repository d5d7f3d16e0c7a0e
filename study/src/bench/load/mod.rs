//! `subsurf-study bench load`: load size and latency, compressed and not.

mod bssrdf;
mod btf;
mod btf_loader;
mod file_loader;
mod homogeneous;
mod one;
mod options;
mod results;
mod table;

use std::path::PathBuf;

use serde_json::json;
use subsurf_cli::outln;
use subsurf_cli::program::failure::bad_request;
use subsurf_encoder::{Unfinished, write_bytes};

use self::bssrdf::{Case, CaseArg, USUAL, measure, write_files};
use self::options::LoadOptions;
use self::table::markdown;

pub(super) use one::{Args as OneArgs, run as run_one};

/// Time how materials load: uncompressed capture, per-pixel profiles and 2-BMPP of the same size, for every technique.
///
/// Each is read, parsed with all checks, uploaded, projected where its technique wants that, and drawn once (64 × 64 pixels), again and
/// again, in a process of its own, with the file in the page cache and without. Times are medians in microseconds. The materials are synthetic:
/// for timing their numbers do not matter. With --btf, a file of yours is timed beside its images. So it
/// is with --files and three files of one material. With --kernel, kernels are timed, with --transfer
/// transfers and the mesh that they are of.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// WIDTHxHEIGHT,WINDOW,M,S; more than once for several. The last of the usual ones has the size of the paper's onyx
    #[arg(long = "case", value_name = "WxH,D,M,S")]
    cases: Vec<CaseArg>,
    /// Files of one material instead: a capture, its per-pixel profiles, its 2-BMPP with a basis
    #[arg(long, value_names = ["CAPTURE", "PROFILES", "BMPP"], num_args = 3, conflicts_with = "cases")]
    files: Option<Vec<PathBuf>>,
    /// A BTF of nested codebooks instead, beside its images in one uncompressed array
    #[arg(long, value_name = "FILE", requires = "images", conflicts_with_all = ["cases", "files"])]
    btf: Option<PathBuf>,
    /// The folder of images of the BTF
    #[arg(long, value_name = "FOLDER", requires = "btf")]
    images: Option<PathBuf>,
    /// Kernels of homogeneous materials instead
    #[arg(long = "kernel", value_name = "FILE", conflicts_with_all = ["cases", "files", "btf", "output"])]
    kernels: Vec<PathBuf>,
    /// Transfers of one mesh instead, of 60 mm
    #[arg(long = "transfer", value_name = "FILE", requires = "mesh", conflicts_with_all = ["cases", "files", "btf", "kernels", "output"])]
    transfers: Vec<PathBuf>,
    /// The mesh of the transfers: a file, or the name of a shape
    #[arg(long, value_name = "FILE|SHAPE", requires = "transfers")]
    mesh: Option<PathBuf>,
    /// Also write loading.md and loading.json into this folder
    #[arg(long, short, value_name = "DIR", conflicts_with = "btf")]
    output: Option<PathBuf>,
    #[command(flatten)]
    options: LoadOptions,
}

pub(super) fn run(args: &Args) -> anyhow::Result<()> {
    let options = &args.options;
    if options.runs == 0 {
        return Err(bad_request("--runs is 0; a median needs one at least, and 20 to be steady"));
    }
    if let (Some(btf), Some(images)) = (&args.btf, &args.images) {
        return btf::run(options, btf, images);
    }
    if !args.kernels.is_empty() {
        return homogeneous::run(options, &args.kernels, None);
    }
    if !args.transfers.is_empty() {
        return homogeneous::run(options, &args.transfers, args.mesh.as_deref());
    }
    let mut results = Vec::new();
    let mut add = |case: &Case| -> anyhow::Result<()> {
        let result = measure(case, options)?;
        if !options.json {
            outln!("{}", markdown(&result));
        }
        results.push(result);
        Ok(())
    };
    if let Some([capture, profiles, bmpp]) = args.files.as_deref() {
        add(&Case::of_files([capture, profiles, bmpp].map(Clone::clone))?)?;
    } else {
        let usual = || USUAL.iter().map(|text| text.parse::<CaseArg>()).collect::<Result<Vec<_>, _>>();
        let cases = if args.cases.is_empty() { usual().map_err(anyhow::Error::msg)? } else { args.cases.clone() };
        let folder = options.folder()?;
        let _goes_when_interrupted = Unfinished::new(folder.path());
        for CaseArg(shape) in cases {
            let case = write_files(folder.path(), &shape)?;
            add(&case)?;
            for file in &case.files {
                // The folder goes at the end anyway; a gigabyte should not wait for it.
                options.done_with(file)?;
            }
        }
    }
    let tables = results.iter().map(markdown).collect::<Vec<_>>().join("\n");
    let report = json!({ "runs": options.runs, "device": options.device()?, "cases": results });
    if options.json {
        outln!("{report:#}");
    }
    if let Some(folder) = &args.output {
        write_bytes(&folder.join("loading.md"), tables.as_bytes())?;
        write_bytes(&folder.join("loading.json"), format!("{report:#}\n").as_bytes())?;
    }
    Ok(())
}
