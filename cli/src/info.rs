//! `subsurf info`: what is in a file.

use std::path::PathBuf;

use anyhow::Context;
use serde_json::json;
use subsurf_decoder::bits::index_bits;
use subsurf_decoder::bssrdf::{Coding, Model, Profiles};
use subsurf_decoder::container::{Container, Crc};
use subsurf_decoder::{Bssrdf, Btf, Section};
use subsurf_encoder::btf::Folder;

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
        return btf_info(args, &bytes, &container);
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

/// What a BTF file says of itself.
fn btf_info(args: &Args, bytes: &[u8], container: &Container<'_>) -> anyhow::Result<()> {
    let file = parse_btf(&args.file, bytes)?;
    let header = file.header();
    let grid = &header.grid;
    let nodes = [grid.n_alpha, grid.n_beta, grid.n_theta, grid.n_phi];
    if args.json {
        let materials: Vec<_> = file
            .materials()
            .map(|of| json!({ "name": of.name(), "width": of.width, "height": of.height, "levels": of.levels }))
            .collect();
        let books: Vec<_> = books(&file)
            .iter()
            .map(|book| json!({ "name": book.name, "entries": book.entries, "items": book.items, "bits": book.bits }))
            .collect();
        let value = json!({
            "model": "nested codebooks", "tone": format!("{:?}", header.tone), "nodes": nodes, "materials": materials,
            "codebooks": books, "bytes": bytes.len(),
        });
        say!("{value:#}");
        return Ok(());
    }
    say!("{}: BTF in nested codebooks, {}", args.file.display(), human(bytes.len() as u64));
    for of in file.materials() {
        let name = if of.name().is_empty() { "unnamed" } else { of.name() };
        say!("  {name}: {} × {} texels, mipmap levels: {}", of.width, of.height, of.levels);
    }
    say!(
        "  nodes of α, sin β, θ, φ: {nodes:?}, lights measured to {:.0}°, views to {:.0}°",
        grid.cos_light_min.acos().to_degrees(),
        grid.theta_max.to_degrees(),
    );
    say!("  {:?}", header.tone);
    for book in books(&file) {
        say!("  {book}");
    }
    for entry in container.entries() {
        say!("  {:<36} {:>10} bytes at {}", entry.section.to_string(), entry.length, entry.offset);
    }
    Ok(())
}

/// A codebook of a BTF, and how many vectors it stands for.
pub(crate) struct BookSize {
    pub(crate) name: String,
    pub(crate) entries: u32,
    /// Items of an entry, and bits of an item.
    pub(crate) items: u32,
    pub(crate) bits: u32,
    /// Vectors of its kind in the resampled data.
    stands_for: u64,
}

impl std::fmt::Display for BookSize {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let bytes = u64::from(self.entries) * u64::from(self.items) * u64::from(self.bits) / 8;
        write!(
            f,
            "{:<9} {:>7} entries of {:>2} × {:>2} bits, {:>9}",
            self.name,
            self.entries,
            self.items,
            self.bits,
            human(bytes)
        )?;
        match self.stands_for.checked_div(self.entries.into()) {
            Some(ratio) if ratio > 1 => write!(f, ", for {} vectors: 1:{ratio}", self.stands_for),
            _ => Ok(()),
        }
    }
}

/// The codebooks of a file, from texels to colours.
pub(crate) fn books(file: &Btf<'_>) -> Vec<BookSize> {
    let (books, grid) = (file.nested().books(), file.grid());
    let chroma = &books.chroma;
    let texels: u64 = file.materials().map(|of| u64::from(of.texels(u8::MAX))).sum();
    let [n_phi, n_theta, n_alpha, n_beta] = [grid.n_phi, grid.n_theta, grid.n_alpha, grid.n_beta].map(u32::from);
    let mut sizes = Vec::new();
    for (number, stage) in books.stages.iter().take(books.count).enumerate() {
        let widths = stage.widths(number == 0, chroma);
        let suffix = if books.count > 1 { format!(", stage {}", number + 1) } else { String::new() };
        let mut stands_for = texels;
        for (k, (name, items)) in [("P6", 1), ("P4", n_phi), ("P3", n_theta), ("P2", n_alpha)].iter().enumerate() {
            sizes.push(BookSize {
                name: format!("{name}{suffix}"),
                entries: stage.books[k].entries,
                items: *items,
                // Codes of scales of P2 stand in bytes of their own.
                bits: widths[k] + if k == 3 { 8 } else { 0 },
                stands_for,
            });
            stands_for *= u64::from(if k == 0 { 1 } else { *items });
        }
        sizes.push(BookSize {
            name: format!("P1{suffix}"),
            entries: stage.slices,
            items: n_beta + 1,
            bits: 8,
            stands_for,
        });
    }
    let slices = texels * u64::from(n_phi) * u64::from(n_theta);
    let p2_bits = index_bits(books.stages[0].books[3].entries);
    let rows = [
        ("M", chroma.merged, 1, p2_bits + index_bits(chroma.i2), slices),
        ("I2", chroma.i2, n_alpha, index_bits(chroma.i1), slices),
        ("I1", chroma.i1, n_beta, index_bits(chroma.colours), slices * u64::from(n_alpha)),
        ("C", chroma.colours, 2, 8, slices * u64::from(n_alpha * n_beta)),
        ("tints", chroma.tints, 2, 8, texels),
    ];
    let size = |(name, entries, items, bits, stands_for): (&str, u32, u32, u32, u64)| BookSize {
        name: name.to_owned(),
        entries,
        items,
        bits,
        stands_for,
    };
    sizes.extend(rows.into_iter().map(size));
    sizes
}

/// The bytes of an input file.
pub(crate) fn read_file(path: &std::path::Path) -> anyhow::Result<Vec<u8>> {
    std::fs::read(path)
        .map_err(|error| crate::failure::bad_request(format!("{}: {error}; expected a .subsurf file", path.display())))
}

/// Parses with all checks, and names the file if it fails.
pub(crate) fn parse<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<Bssrdf<'a>> {
    Bssrdf::parse_with(bytes, Crc::Check).map_err(|error| read_error(path, error)).context("not a usable material")
}

/// [`parse`] of a BTF.
pub(crate) fn parse_btf<'a>(path: &std::path::Path, bytes: &'a [u8]) -> anyhow::Result<Btf<'a>> {
    Btf::parse_with(bytes, Crc::Check).map_err(|error| read_error(path, error)).context("not a usable BTF")
}

/// What a file holds.
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
    if container.entries().any(|entry| entry.section == Section::BtfHeader) {
        parse_btf(path, bytes).map(Parsed::Btf)
    } else {
        parse(path, bytes).map(Parsed::Bssrdf)
    }
}

fn read_error(path: &std::path::Path, source: subsurf_decoder::ReadError) -> subsurf_encoder::Error {
    subsurf_encoder::Error::Read { path: path.to_owned(), source }
}
