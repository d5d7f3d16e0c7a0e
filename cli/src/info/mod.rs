//! `subsurf info`: what is in a file.

mod btf;

use std::path::PathBuf;

use anyhow::Context;
use serde_json::json;
use subsurf_decoder::bssrdf::{BssrdfModel, Coding, Profiles};
use subsurf_decoder::{Bssrdf, Content, Family, File, NestedBtf, ReadError};
use subsurf_encoder::btf::Folder;

pub(crate) use btf::{Parts, material_number};

use crate::failure::bad_request;
use crate::memory::human;
use crate::say::say;

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
        say!("{value:#}");
        return Ok(());
    }
    let pixels = if folder.is_linear() { "linear floats" } else { "8-bit sRGB" };
    say!(
        "{}: images of a BTF, {} lights × {} views, {width} × {height} pixels, {pixels}, {} uncompressed",
        args.file.display(),
        folder.lights().len(),
        folder.views().len(),
        human(folder.raw_bytes()),
    );
    if let Some(facts) = simulated {
        say!("  synthetic: {facts}");
    }
    Ok(())
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if args.file.is_dir() {
        return folder_info(args);
    }
    let bytes = read_file(&args.file)?;
    let file = parse_file(&args.file, &bytes)?;
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
        say!("{value:#}");
        return Ok(());
    }
    say!("{}: {model}, {}", args.file.display(), human(bytes.len() as u64));
    say!(
        "  {} × {} pixels of {} mm, beyond the border: {:?}",
        header.width,
        header.height,
        header.pitch_mm,
        header.addressing
    );
    say!(
        "  window {0} × {0} pixels, profiles of {1} nodes up to {2:.2} mm, {3} base materials",
        2 * u32::from(header.window_radius) + 1,
        header.samples,
        header.r_max_mm,
        header.base_materials,
    );
    say!("  refractive index {}, linear Rec. 709", header.eta);
    for entry in container.entries() {
        say!("  {:<36} {:>10} bytes at {}", entry.section.to_string(), entry.length, entry.offset);
    }
    Ok(())
}

/// The bytes of an input file.
pub(crate) fn read_file(path: &std::path::Path) -> anyhow::Result<Vec<u8>> {
    std::fs::read(path).map_err(|error| bad_request(format!("{}: {error}; expected a .subsurf file", path.display())))
}

/// Parses with all checks, and names the file if it fails.
pub(crate) fn parse<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<Bssrdf<'a>> {
    Bssrdf::parse(bytes).map_err(|error| read_error(path, error)).context("not a usable material")
}

/// [`parse`] of a file of any family.
fn parse_file<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<File<'a>> {
    File::parse(bytes).map_err(|error| read_error(path, error)).context("not a usable file")
}

/// What a file holds that can be drawn.
#[derive(Clone, Copy)]
#[allow(clippy::large_enum_variant, reason = "one at a time")]
pub(crate) enum Parsed<'a> {
    /// A translucent material.
    Bssrdf(Bssrdf<'a>),
    /// A bidirectional texture function.
    Btf(NestedBtf<'a>),
}

/// [`parse`] of either.
pub(crate) fn parse_any<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<Parsed<'a>> {
    match parse_file(path, bytes)?.content() {
        Content::Bssrdf(material) => Ok(Parsed::Bssrdf(material)),
        Content::NestedBtf(btf) => Ok(Parsed::Btf(btf)),
        other => Err(not_drawn(path, other.family())),
    }
}

/// [`parse`] of a BTF that can be drawn.
pub(crate) fn parse_btf<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<NestedBtf<'a>> {
    NestedBtf::parse(bytes).or_else(|error| match error {
        ReadError::OtherFamily { found: found @ Family::FactoredBtf, .. } => Err(not_drawn(path, found)),
        error => Err(read_error(path, error)).context("not a usable BTF"),
    })
}

fn not_drawn(path: &std::path::Path, family: Family) -> anyhow::Error {
    let why = "which only the library evaluates; encode it with --method nested to draw it";
    bad_request(format!("{}: a {family}, {why}", path.display()))
}

pub(crate) fn read_error(path: &std::path::Path, source: subsurf_decoder::ReadError) -> subsurf_encoder::Error {
    subsurf_encoder::Error::Read { path: path.to_owned(), source }
}
