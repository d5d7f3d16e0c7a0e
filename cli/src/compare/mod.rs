//! `subsurf compare`: how far a file is from what it was made from.

mod btf;

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use subsurf_encoder::capture::is_btf;
use subsurf_encoder::metrics::bssrdf::{Judgement, Light, judge};
use subsurf_scene::{MESH_EXTENSIONS, SHAPES};
use subsurf_viewer::{human, read};

pub(crate) use btf::{mssim, mssim_json};

use crate::info::parse;
use crate::options::{CaptureArgs, MeshArgs};
use crate::outln;
use crate::picture::{montage, triptych, write_picture};
use crate::program::failure::bad_request;
use crate::program::progress::Bars;
use crate::transfer;

/// Judge a file against the capture it was made from.
///
/// Mean relative error of the diffuse albedo, and PSNR and SSIM of the patch lit uniformly, by a disc and by a line
/// (Yatagawa et al. 2020, section 4; Wang et al. 2004). Only measured entries count, on both sides.
///
/// Of a transfer file: its rms error on q, and e_rms in images of the mesh (Hao and Varshney 2004, section 3.3).
///
/// Of a BTF: MSSIM of Y, Cr and Cb and PSNR over its pairs of directions, and the sizes of its codebooks.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The capture, .npy or .npz; a folder of BTF images, a .btf file, or an isotropic BRDF of MERL (.binary) or RGL
    /// (.bsdf); of a transfer file the mesh it was made for
    capture: PathBuf,
    /// The .subsurf file
    file: PathBuf,
    #[command(flatten)]
    facts: CaptureArgs,
    #[command(flatten)]
    size: MeshArgs,
    /// Report as JSON
    #[arg(long)]
    json: bool,
    /// Write pictures into this folder: original, file, and ten times their difference (of BTFs, five times)
    #[arg(long, value_name = "DIR")]
    images: Option<PathBuf>,
    /// Of a file of several BTFs: the material's name or number
    #[arg(long, value_name = "NAME")]
    material: Option<String>,
    /// Of BTFs: compare every n-th pair of directions only
    #[arg(long, default_value_t = 1, value_name = "N")]
    every: usize,
}

/// Whether a path is that of a mesh or names a shape.
fn is_mesh(path: &Path) -> bool {
    let extension = path.extension().map(|own| own.to_string_lossy().to_lowercase());
    extension.map_or_else(
        || SHAPES.iter().any(|shape| path.as_os_str() == *shape),
        |own| MESH_EXTENSIONS.contains(&own.as_str()),
    )
}

/// A PSNR for tables, in dB; a dash where the light meets nothing that was measured.
pub fn db(psnr: Option<f64>) -> String {
    psnr.map_or_else(|| "-".to_owned(), |psnr| format!("{psnr:.1}"))
}

/// A judgement as JSON.
pub(crate) fn to_json(judgement: &Judgement) -> Value {
    let [uniform, disc, line] = judgement.psnr_db;
    let [ssim_uniform, ssim_disc, ssim_line] = judgement.ssim;
    json!({
        "relative_error_mean": judgement.relative_error_mean,
        "psnr_db": { "uniform": uniform, "disc": disc, "line": line },
        "ssim": { "uniform": ssim_uniform, "disc": ssim_disc, "line": ssim_line },
        "bytes": judgement.bytes,
        "capture_bytes": judgement.capture_bytes,
    })
}

/// Prints a judgement.
pub(crate) fn print(judgement: &Judgement) {
    #[allow(clippy::cast_precision_loss, reason = "a ratio for people")]
    let ratio = judgement.capture_bytes as f64 / judgement.bytes as f64;
    outln!("  {} of {}: 1:{ratio:.0}", human(judgement.bytes), human(judgement.capture_bytes));
    outln!("  mean relative error of the diffuse albedo {:.4}", judgement.relative_error_mean);
    for ((light, psnr), ssim) in Light::ALL.iter().zip(judgement.psnr_db).zip(judgement.ssim) {
        let ssim = ssim.map_or_else(|| "- (patch too small)".to_owned(), |ssim| format!("{ssim:.4}"));
        let psnr = psnr.map_or_else(|| "- (nothing is lit)".to_owned(), |psnr| format!("{psnr:5.1} dB"));
        outln!("  {:<8} PSNR {psnr}   SSIM {ssim}", light.name());
    }
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    // A folder may have the name of a shape.
    if is_btf(&args.capture) {
        return btf::run(args);
    }
    if is_mesh(&args.capture) {
        return transfer::compare(&args.capture, &args.size, &args.file, args.json);
    }
    let capture = args.facts.open(&args.capture)?;
    let bytes = read(&args.file)?;
    let material = parse(&args.file, &bytes)?;
    let judgement = judge(&capture, &material, bytes.len() as u64, &Bars::new())?;
    if args.json {
        outln!("{:#}", to_json(&judgement));
    } else {
        outln!("{} against {}", args.file.display(), args.capture.display());
        print(&judgement);
    }
    if let Some(folder) = &args.images {
        std::fs::create_dir_all(folder)
            .map_err(|error| bad_request(format!("{}: cannot make the folder: {error}", folder.display())))?;
        let mut rows = Vec::new();
        for (light, relit) in Light::ALL.iter().zip(&judgement.comparison.lit) {
            let row = triptych(relit, capture.width());
            write_picture(&folder.join(format!("{}.png", light.name())), &montage(std::slice::from_ref(&row)))?;
            rows.push(row);
        }
        write_picture(&folder.join("comparison.png"), &montage(&rows))?;
        if !args.json {
            outln!("pictures (original, file, 10 × difference) in {}", folder.display());
        }
    }
    Ok(())
}
