//! `subsurf info`: what is in a file.

mod btf;

use std::path::PathBuf;

use anyhow::Context;
use serde_json::json;
use subsurf_decoder::bssrdf::{BssrdfModel, Coding, Profiles};
use subsurf_decoder::{Bssrdf, Content, File};
use subsurf_encoder::capture::Folder;
use subsurf_viewer::read;

pub use btf::{CodebookSize, FactorSizes, Parts};

use crate::outln;
use subsurf_viewer::human;

/// Show what a .subsurf file holds, or a folder of BTF images, and check all of it.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The file, or the folder
    file: PathBuf,
    /// As JSON
    #[arg(long)]
    json: bool,
}

/// What is known of a BTF from the names and sizes of its images.
fn folder_info(args: &Args) -> anyhow::Result<()> {
    let folder = Folder::open(&args.file)?;
    let [width, height] = folder.size();
    let facts = folder.facts();
    let simulated = facts.as_ref().and_then(|facts| facts.get("simulated"));
    if args.json {
        let value = json!({
            "lights": folder.lights().len(), "views": folder.views().len(), "width": width, "height": height,
            "linear": folder.is_linear(), "raw_bytes": folder.raw_bytes(), "simulated": simulated,
        });
        outln!("{value:#}");
        return Ok(());
    }
    let pixels = if folder.is_linear() { "linear floats" } else { "8-bit sRGB" };
    outln!(
        "{}: images of a BTF, {} lights × {} views, {width} × {height} pixels, {pixels}, {} uncompressed",
        args.file.display(),
        folder.lights().len(),
        folder.views().len(),
        human(folder.raw_bytes()),
    );
    if let Some(facts) = simulated {
        outln!("  synthetic: {facts}");
    }
    Ok(())
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.file.is_dir() {
        return folder_info(args);
    }
    let bytes = read(&args.file)?;
    let file = File::parse(&bytes).map_err(|error| read_error(&args.file, error)).context("not a usable material")?;
    let container = file.container();
    let Content::Bssrdf(material) = file.content() else { return btf::info(args, &bytes, &file) };
    let header = material.header();
    let model = match material.model() {
        BssrdfModel::BaseMaterials(planes) => {
            let coding = match header.coding {
                Coding::Exact => "",
                Coding::SmallRatios => ", ratios in 8 bits",
                Coding::Palette => ", pairs from a palette",
            };
            let half = if matches!(planes.profiles, Profiles::F16(_)) { ", profiles in half precision" } else { "" };
            format!("{}-BMPP (base materials per pixel: {}{coding}{half})", header.model, header.model)
        }
        BssrdfModel::PerPixel(_) => "per-pixel profiles".to_owned(),
    };
    if args.json {
        let sections: Vec<_> = container
            .entries()
            .map(|entry| json!({ "kind": entry.section.kind().escape_ascii().to_string(), "bytes": entry.length }))
            .collect();
        let value = json!({
            "model": model, "width": header.width, "height": header.height, "base_materials": header.base_materials,
            "samples": header.samples, "window_radius": header.window_radius, "pitch_mm": header.pitch_mm,
            "r_max_mm": header.r_max_mm, "eta": header.eta, "addressing": format!("{:?}", header.addressing).to_lowercase(),
            "bytes": bytes.len(), "sections": sections,
        });
        outln!("{value:#}");
        return Ok(());
    }
    outln!("{}: {model}, {}", args.file.display(), human(bytes.len() as u64));
    outln!(
        "  {} × {} pixels of {} mm, beyond the border: {:?}",
        header.width,
        header.height,
        header.pitch_mm,
        header.addressing
    );
    outln!(
        "  window {0} × {0} pixels, profiles of {1} nodes up to {2:.2} mm, {3} base materials",
        2 * u32::from(header.window_radius) + 1,
        header.samples,
        header.r_max_mm,
        header.base_materials,
    );
    outln!("  refractive index {}, linear Rec. 709", header.eta);
    for entry in container.entries() {
        outln!("  {:<36} {:>10} bytes at {}", entry.section.to_string(), entry.length, entry.offset);
    }
    Ok(())
}

/// Parses with all checks, and names the file if it fails.
pub fn parse<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<Bssrdf<'a>> {
    Bssrdf::parse(bytes).map_err(|error| read_error(path, error)).context("not a usable material")
}

pub(crate) fn read_error(path: &std::path::Path, source: subsurf_decoder::ReadError) -> subsurf_encoder::Error {
    subsurf_encoder::Error::Read { path: path.to_owned(), source }
}
