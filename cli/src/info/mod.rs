//! `subsurf info`: what is in a file.

mod btf;
mod kernel;
mod source;
mod transfer;

use std::path::PathBuf;

use anyhow::Context;
use serde_json::{Map, Value, json};
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::bssrdf::{BssrdfModel, Coding, Profiles, SeparableBasis};
use subsurf_decoder::container::Container;
use subsurf_decoder::{Bssrdf, Content, File, ReadError};
use subsurf_encoder::capture::is_btf;
use subsurf_viewer::read;

pub use btf::{CodebookSize, FactorSizes, Parts};

use crate::outln;
use crate::program::failure::read_error;
use subsurf_viewer::human;

/// Show what a .subsurf file holds, or a BTF that others made: a folder of images, a .btf, .binary or .bsdf file. All of it
/// is read and checked.
#[derive(clap::Args)]
pub(crate) struct Args {
    /// The file, or the folder of images
    file: PathBuf,
    /// As JSON
    #[arg(long)]
    json: bool,
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    if is_btf(&args.file) {
        return source::info(args);
    }
    let bytes = read(&args.file)?;
    let file = File::parse(&bytes).map_err(|error| read_error(&args.file, error)).context("not a usable material")?;
    let material = match file.content() {
        Content::Bssrdf(material) => material,
        Content::Kernel(of) => {
            kernel::info(args, &bytes, &file, &of);
            return Ok(());
        }
        Content::Transfer(of) => {
            transfer::info(args, &bytes, &file, &of);
            return Ok(());
        }
        _ => return btf::info(args, &bytes, &file),
    };
    let container = file.container();
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
            "basis": material.basis().map(basis_to_json), "bytes": bytes.len(), "sections": sections,
        });
        print_json(value, container);
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
    match material.basis() {
        Some(basis) => outln!("  {}", basis_line(basis)),
        None => outln!("  no separable basis: `subsurf encode --add-basis FILE` adds one"),
    }
    print_rest(container);
    Ok(())
}

/// Metadata, and kinds, lengths and places of all sections.
fn print_rest(container: &Container<'_>) {
    match metadata(container) {
        Ok(entries) => {
            for (key, value) in entries {
                outln!("  {}: {}", printable(key), printable(value));
            }
        }
        // The rest of the file is good.
        Err(error) => outln!("  no metadata: {error}"),
    }
    for entry in container.entries() {
        outln!("  {:<36} {:>10} bytes at {}", entry.section.to_string(), entry.length, entry.offset);
    }
}

/// What is known of a file, with its metadata; null where that is damaged.
fn print_json(mut value: Value, container: &Container<'_>) {
    value["metadata"] = match metadata(container) {
        Ok(entries) => {
            entries.into_iter().map(|(key, value)| (key.to_owned(), value.into())).collect::<Map<_, _>>().into()
        }
        Err(_) => Value::Null,
    };
    outln!("{value:#}");
}

/// Keys and values of a file, every key once: the last counts.
fn metadata<'a>(container: &Container<'a>) -> Result<Vec<(&'a str, &'a str)>, ReadError> {
    let mut entries: Vec<(&str, &str)> = Vec::new();
    for entry in container.metadata()? {
        entries.retain(|(key, _)| *key != entry.0);
        entries.push(entry);
    }
    Ok(entries)
}

/// Text of a file for a terminal, which would obey its control characters, those that turn the direction of writing among them.
fn printable(text: &str) -> String {
    let is_obeyed = |letter: char| {
        letter.is_control()
            || matches!(letter, '\u{200B}'..='\u{200F}' | '\u{202A}'..='\u{202E}' | '\u{2060}'..='\u{206F}' | '\u{FEFF}')
    };
    text.chars()
        .map(|letter| if is_obeyed(letter) { letter.escape_default().to_string() } else { letter.into() })
        .collect()
}

/// A separable basis in a line.
pub(crate) fn basis_line(basis: &SeparableBasis<'_>) -> String {
    let BasisSize { terms, gaussians } = basis.size();
    let widths: Vec<String> = basis.sigmas().map(|sigma| format!("{sigma:.2}")).collect();
    format!("separable basis: maps: {terms}, Gaussians: {gaussians}, of σ = {} pixels", widths.join(", "))
}

/// The same as JSON.
pub(crate) fn basis_to_json(basis: &SeparableBasis<'_>) -> serde_json::Value {
    let BasisSize { terms, gaussians } = basis.size();
    json!({ "terms": terms, "gaussians": gaussians, "sigmas_px": basis.sigmas().collect::<Vec<_>>() })
}

/// Parses with all checks, and names the file if it fails.
pub fn parse<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<Bssrdf<'a>> {
    Bssrdf::parse(bytes).map_err(|error| read_error(path, error)).context("not a usable material")
}
