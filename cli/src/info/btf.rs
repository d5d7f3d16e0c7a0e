//! What BTF files of both models say of themselves.

use std::path::Path;

use anyhow::Context;
use serde_json::{Value, json};
use subsurf_decoder::container::bits::index_bits;
use subsurf_decoder::{Content, Family, File, NestedBtf, ReadError};

use super::{Args, print_json, print_rest, printable};
use crate::outln;
use crate::program::failure::read_error;
use subsurf_viewer::human;

pub(super) fn info(args: &Args, bytes: &[u8], file: &File<'_>) -> anyhow::Result<()> {
    let content = file.content();
    let catalog = content.catalog().ok_or_else(|| not_a_btf(&args.file, &content))?;
    let parts = Parts::of_content(&args.file, &content)?;
    let (header, grid) = (catalog.header(), catalog.grid());
    let nodes = [grid.n_alpha, grid.n_beta, grid.n_theta, grid.n_phi];
    if args.json {
        let materials: Vec<_> = catalog
            .materials()
            .map(|of| json!({ "name": of.name(), "width": of.width, "height": of.height, "levels": of.levels }))
            .collect();
        let value = json!({
            "model": parts.model(), "tone": format!("{:?}", header.encoding), "nodes": nodes, "materials": materials,
            "texel_mm": header.texel_mm, "parts": parts.to_json(), "bytes": bytes.len(),
        });
        print_json(value, file.container());
        return Ok(());
    }
    outln!("{}: BTF in {}, {}", args.file.display(), parts.model(), human(bytes.len() as u64));
    for of in catalog.materials() {
        let name = if of.name().is_empty() { "unnamed".to_owned() } else { printable(of.name()) };
        outln!("  {name}: {} × {} texels, mipmap levels: {}", of.width, of.height, of.levels);
    }
    outln!(
        "  nodes of α, sin β, θ, φ: {nodes:?}, lights measured to {:.0}°, views to {:.0}°",
        grid.cos_light_min.acos().to_degrees(),
        grid.theta_max.to_degrees(),
    );
    outln!("  {:?}", header.encoding);
    if let Some(texel_mm) = header.texel_mm {
        outln!("  texels of {texel_mm} mm");
    }
    parts.print();
    print_rest(file.container());
    Ok(())
}

fn not_a_btf(path: &Path, content: &Content<'_>) -> anyhow::Error {
    let other = ReadError::OtherFamily { found: content.family(), expected: Family::NestedBtf };
    anyhow::Error::new(read_error(path, other)).context("not a usable BTF")
}

/// What a file is made of.
pub enum Parts {
    /// Nested codebooks.
    Codebooks(Vec<CodebookSize>),
    /// Factors.
    Factors(FactorSizes),
}

/// Numbers of everything in a file of factors.
pub struct FactorSizes {
    luma: u8,
    chroma: u8,
    /// Codewords of every stage.
    words: Vec<u16>,
    view_axes: u8,
    light_axes: u8,
    /// Bytes that it takes to be evaluated.
    expanded: usize,
}

impl Parts {
    /// Checks all of a file.
    pub fn of(path: &Path, bytes: &[u8]) -> anyhow::Result<Self> {
        let file = File::parse(bytes).map_err(|error| read_error(path, error)).context("not a usable BTF")?;
        Self::of_content(path, &file.content())
    }

    fn of_content(path: &Path, content: &Content<'_>) -> anyhow::Result<Self> {
        match content {
            Content::NestedBtf(btf) => Ok(Self::Codebooks(books(btf))),
            Content::FactoredBtf(btf) => {
                let shape = btf.shape();
                Ok(Self::Factors(FactorSizes {
                    luma: shape.luma,
                    chroma: shape.chroma,
                    words: shape.stages().iter().map(|stage| stage.words).collect(),
                    view_axes: shape.view_axes,
                    light_axes: shape.light_axes,
                    expanded: btf.table_len() + 2 * btf.words_len(),
                }))
            }
            other => Err(not_a_btf(path, other)),
        }
    }

    pub(crate) fn model(&self) -> &'static str {
        match self {
            Self::Codebooks(_) => "nested codebooks",
            Self::Factors(_) => "factors",
        }
    }

    pub(crate) fn print(&self) {
        match self {
            Self::Codebooks(books) => books.iter().for_each(|book| outln!("  {book}")),
            Self::Factors(FactorSizes { luma, chroma, words, view_axes, light_axes, expanded }) => {
                outln!("  components: {luma} of luma, {chroma} of chroma");
                outln!("  codewords of {} stages: {words:?}", words.len());
                outln!("  axes: {view_axes} of views, {light_axes} of lights");
                outln!("  expanded when loaded: {}", human(*expanded as u64));
            }
        }
    }

    pub(crate) fn to_json(&self) -> Value {
        match self {
            Self::Codebooks(books) => {
                let book = |book: &CodebookSize| json!({ "name": book.name, "entries": book.entries, "items": book.items, "bits": book.bits });
                books.iter().map(book).collect()
            }
            Self::Factors(FactorSizes { luma, chroma, words, view_axes, light_axes, expanded }) => json!({
                "luma": luma, "chroma": chroma, "codewords": words, "view_axes": view_axes, "light_axes": light_axes,
                "expanded_bytes": expanded,
            }),
        }
    }
}

/// A codebook of a BTF, and how many vectors it stands for.
pub struct CodebookSize {
    /// P1 to P6 of the paper and the stage, or of chroma M, I2, I1, C and tints.
    pub name: String,
    /// Number of its entries.
    pub entries: u32,
    /// Items of an entry.
    pub(crate) items: u32,
    /// Bits of an item.
    pub(crate) bits: u32,
    /// Vectors of its kind in the resampled data.
    pub stands_for: u64,
}

impl std::fmt::Display for CodebookSize {
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
fn books(file: &NestedBtf<'_>) -> Vec<CodebookSize> {
    let (books, grid) = (file.codebooks().sizes(), file.grid());
    let chroma = &books.chroma;
    let texels: u64 = file.materials().map(|of| u64::from(of.texels(u8::MAX))).sum();
    let [n_phi, n_theta, n_alpha, n_beta] = [grid.n_phi, grid.n_theta, grid.n_alpha, grid.n_beta].map(u32::from);
    let mut sizes = Vec::new();
    for (number, stage) in books.stages.iter().take(books.count).enumerate() {
        let widths = stage.widths(number == 0, chroma);
        let suffix = if books.count > 1 { format!(", stage {}", number + 1) } else { String::new() };
        let mut stands_for = texels;
        for (k, (name, items)) in [("P6", 1), ("P4", n_phi), ("P3", n_theta), ("P2", n_alpha)].iter().enumerate() {
            sizes.push(CodebookSize {
                name: format!("{name}{suffix}"),
                entries: stage.codebooks[k].entries,
                items: *items,
                // Codes of scales of P2 stand in bytes of their own.
                bits: widths[k] + if k == 3 { 8 } else { 0 },
                stands_for,
            });
            stands_for *= u64::from(if k == 0 { 1 } else { *items });
        }
        sizes.push(CodebookSize {
            name: format!("P1{suffix}"),
            entries: stage.slices,
            items: n_beta + 1,
            bits: 8,
            stands_for,
        });
    }
    let slices = texels * u64::from(n_phi) * u64::from(n_theta);
    let p2_bits = index_bits(books.stages[0].codebooks[3].entries);
    let rows = [
        ("M", chroma.merged, 1, p2_bits + index_bits(chroma.i2), slices),
        ("I2", chroma.i2, n_alpha, index_bits(chroma.i1), slices),
        ("I1", chroma.i1, n_beta, index_bits(chroma.colours), slices * u64::from(n_alpha)),
        ("C", chroma.colours, 2, 8, slices * u64::from(n_alpha * n_beta)),
        ("tints", chroma.tints, 2, 8, texels),
    ];
    let size = |(name, entries, items, bits, stands_for): (&str, u32, u32, u32, u64)| CodebookSize {
        name: name.to_owned(),
        entries,
        items,
        bits,
        stands_for,
    };
    sizes.extend(rows.into_iter().map(size));
    sizes
}
