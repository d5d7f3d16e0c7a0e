//! `subsurf info`: what is in a file.

mod btf;

use std::path::PathBuf;

use anyhow::Context;
use serde_json::json;
use subsurf_decoder::bssrdf::{Coding, Model, Profiles};
use subsurf_decoder::btf::{Catalog, Model as BtfModel};
use subsurf_decoder::container::{Container, Crc};
use subsurf_decoder::{Bssrdf, Btf, Section};
use subsurf_encoder::capture::Folder;

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
    let container = Container::parse(&bytes).map_err(|error| read_error(&args.file, error))?;
    if container.entries().any(|entry| entry.section == Section::BtfHeader) {
        return btf::info(args, &bytes, &container);
    }
    let material = parse(&args.file, &bytes)?;
    let header = material.header();
    let model = match material.model() {
        Model::BaseMaterials(planes) => {
            let coding = match header.coding {
                Coding::Exact => "",
                Coding::SmallRatios => ", ratios in 8 bits",
                Coding::Palette => ", pairs from a palette",
            };
            let half = if matches!(planes.profiles, Profiles::F16(_)) { ", profiles in half precision" } else { "" };
            format!("{}-BMPP (base materials per pixel: {}{coding}{half})", header.model, header.model)
        }
        Model::PerPixel(_) => "per-pixel profiles".to_owned(),
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
    Bssrdf::parse_with(bytes, Crc::Check).map_err(|error| read_error(path, error)).context("not a usable material")
}

/// What a file holds that can be drawn.
#[derive(Clone, Copy)]
#[allow(clippy::large_enum_variant, reason = "one at a time")]
pub(crate) enum Parsed<'a> {
    /// A translucent material.
    Bssrdf(Bssrdf<'a>),
    /// A bidirectional texture function.
    Btf(Btf<'a>),
}

/// [`parse`] of either.
pub(crate) fn parse_any<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<Parsed<'a>> {
    let container =
        Container::parse(bytes).map_err(|error| read_error(path, error)).context("not a usable material")?;
    if !container.entries().any(|entry| entry.section == Section::BtfHeader) {
        return parse(path, bytes).map(Parsed::Bssrdf);
    }
    parse_btf(path, bytes).map(Parsed::Btf)
}

/// [`parse`] of a BTF that can be drawn.
pub(crate) fn parse_btf<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<Btf<'a>> {
    Btf::parse_with(bytes, Crc::Check).or_else(|error| {
        let model = Catalog::parse(bytes, Crc::Check).map(|catalog| catalog.header().model);
        if matches!(model, Ok(BtfModel::Factored)) {
            let what = "a BTF of factors, which only the library evaluates; encode it with --method nested to draw it";
            return Err(bad_request(format!("{}: {what}", path.display())));
        }
        Err(read_error(path, error)).context("not a usable BTF")
    })
}

pub(crate) fn read_error(path: &std::path::Path, source: subsurf_decoder::ReadError) -> subsurf_encoder::Error {
    subsurf_encoder::Error::Read { path: path.to_owned(), source }
}
