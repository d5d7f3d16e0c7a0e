//! `subsurf compare` of BTFs: how far a file is from the images it was made from.

use std::path::Path;

use serde_json::{Value, json};
use subsurf_decoder::btf::{Catalog, Evaluate};
use subsurf_encoder::capture::{Images, load_btf};
use subsurf_encoder::metrics::btf::{BtfError, compare, decode, with_file};
use subsurf_viewer::{human, material_number, read};

use super::Args;
use crate::info::Parts;
use crate::outln;
use crate::picture::{display, montage, write_picture};
use crate::program::failure::{bad_request, read_error};
use crate::program::progress::Bars;

/// Pairs of directions that pictures are made of: shares of all of them.
const PICTURED: [f64; 6] = [0.003, 0.12, 0.31, 0.52, 0.73, 0.96];
/// How many times differences are shown.
const MAGNIFIED: f32 = 5.0;

pub(super) fn run(args: &Args) -> anyhow::Result<()> {
    let bytes = read(&args.file)?;
    let parts = Parts::of(&args.file, &bytes)?;
    with_file(&bytes, |file| compare_with(args, file, &parts, bytes.len()))
        .map_err(|error| read_error(&args.file, error))?
}

fn compare_with(args: &Args, file: &(dyn Evaluate + Sync), parts: &Parts, bytes: usize) -> anyhow::Result<()> {
    let images = load_btf(&args.capture, &Bars::new())?;
    let material = material_of(args, file.catalog())?;
    let of_file = file.catalog().materials().nth(material).map(|material| material.size(0));
    if of_file != Some(images.size()) {
        let [width, height] = images.size();
        return Err(bad_request(format!(
            "{}: images of {width} × {height} pixels, and the file's material has {of_file:?}",
            args.capture.display()
        )));
    }
    let pairs: Vec<usize> = (0..images.pairs()).step_by(args.every.max(1)).collect();
    let error = compare(&images, file, material, &pairs, &Bars::new());
    if args.json {
        outln!("{:#}", to_json(&error, parts, &images, bytes));
    } else {
        print(args, &error, parts, &images, bytes);
    }
    if let Some(folder) = &args.images {
        pictures(folder, &images, file, material)?;
        if !args.json {
            outln!("pictures (original, file, {MAGNIFIED} × difference) in {}", folder.display());
        }
    }
    Ok(())
}

/// The number of the material that is asked for, by name or number; the only one if none is.
fn material_of(args: &Args, file: &Catalog<'_>) -> anyhow::Result<usize> {
    let names: Vec<String> = file.materials().map(|material| material.name().to_owned()).collect();
    let Some(asked) = &args.material else {
        let folder = args.capture.file_stem().map(|stem| stem.to_string_lossy().into_owned());
        let named = names.iter().position(|name| Some(name) == folder.as_ref());
        return named
            .or((names.len() == 1).then_some(0))
            .ok_or_else(|| bad_request(format!("--material is needed: the file has {}", names.join(", "))));
    };
    material_number(&names, asked)
        .ok_or_else(|| bad_request(format!("no material {asked}: the file has {}", names.join(", "))))
}

/// Structural similarities as JSON has them; null if there are none.
pub(crate) fn mssim_json(error: &BtfError) -> Value {
    let of = |[luma, cr, cb]: [f64; 3]| json!({ "y": luma, "cr": cr, "cb": cb, "mean": error.mean_mssim() });
    error.mssim.map_or(Value::Null, of)
}

/// Structural similarities for people.
pub(crate) fn mssim(error: &BtfError) -> String {
    match (error.mssim, error.mean_mssim()) {
        (Some([luma, cr, cb]), Some(mean)) => format!("MSSIM {mean:.4} (Y {luma:.4}, Cr {cr:.4}, Cb {cb:.4})"),
        _ => "MSSIM - (images smaller than 11 × 11 pixels)".to_owned(),
    }
}

fn to_json(error: &BtfError, parts: &Parts, images: &Images, bytes: usize) -> Value {
    json!({
        "mssim": mssim_json(error), "psnr_db": error.psnr_db,
        "pairs": error.pairs, "bytes": bytes, "raw_bytes": images.bytes(), "parts": parts.to_json(),
    })
}

fn print(args: &Args, error: &BtfError, parts: &Parts, images: &Images, bytes: usize) {
    outln!("{} against {}", args.file.display(), args.capture.display());
    #[allow(clippy::cast_precision_loss, reason = "a ratio for people")]
    let ratio = images.bytes() as f64 / bytes as f64;
    outln!("  {} of {}: 1:{ratio:.0}", human(bytes as u64), human(images.bytes()));
    outln!("  {} over {} pairs", mssim(error), error.pairs);
    outln!("  PSNR  {:.1} dB", error.psnr_db);
    parts.print();
}

fn pictures(folder: &Path, images: &Images, file: &(dyn Evaluate + Sync), material: usize) -> anyhow::Result<()> {
    std::fs::create_dir_all(folder)
        .map_err(|error| bad_request(format!("{}: cannot make the folder: {error}", folder.display())))?;
    let [width, _] = images.size();
    let tone = file.catalog().header().encoding;
    // Linear images are shown at an exposure that makes their mean a middle grey.
    let exposure = match tone {
        subsurf_decoder::btf::ColourEncoding::Display { .. } => None,
        subsurf_decoder::btf::ColourEncoding::LogLuv { toe, .. } => Some(0.01 / toe),
    };
    let mut rows = Vec::new();
    for share in PICTURED {
        let pair = images.pair_at(share);
        let original = images.image(pair);
        let decoded = decode(images, file, material, pair);
        let difference: Vec<[f32; 3]> =
            original.iter().zip(&decoded).map(|(a, b)| [0, 1, 2].map(|c| MAGNIFIED * (a[c] - b[c]).abs())).collect();
        rows.push(vec![
            display(&original, width, exposure),
            display(&decoded, width, exposure),
            display(&difference, width, exposure),
        ]);
    }
    write_picture(&folder.join("comparison.png"), &montage(&rows))
}
