//! Material files: reading and parsing those that can be drawn.

use std::path::Path;

use subsurf_decoder::{Bssrdf, Family, File, NestedBtf, ReadError};

use crate::error::{Error, Result};

/// Material of a file that can be drawn.
#[derive(Clone, Copy)]
#[allow(clippy::large_enum_variant, reason = "one at a time")]
pub enum DrawnMaterial<'a> {
    /// A translucent material.
    Bssrdf(Bssrdf<'a>),
    /// Bidirectional texture functions in nested codebooks.
    Btf(NestedBtf<'a>),
}

/// Bytes of a material file.
///
/// # Errors
/// [`Error::Open`] if the system refuses.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    std::fs::read(path).map_err(|source| Error::Open { path: path.to_owned(), source })
}

/// Parses a material file with all checks, CRC-32 included; `path` is for messages only.
///
/// # Errors
/// [`Error::File`] for broken files, [`Error::Request`] for a factored BTF, which is not drawn.
pub fn parse<'a>(path: &Path, bytes: &'a [u8]) -> Result<DrawnMaterial<'a>> {
    let file = File::parse(bytes);
    let file = file.map_err(|source| Error::File { path: path.to_owned(), kind: "material", source })?;
    match file.content() {
        subsurf_decoder::Content::Bssrdf(material) => Ok(DrawnMaterial::Bssrdf(material)),
        subsurf_decoder::Content::NestedBtf(btf) => Ok(DrawnMaterial::Btf(btf)),
        other => Err(not_drawn(path, other.family())),
    }
}

/// [`parse`] of a file that has to be a BTF.
///
/// # Errors
/// As [`parse`].
pub fn parse_btf<'a>(path: &Path, bytes: &'a [u8]) -> Result<NestedBtf<'a>> {
    NestedBtf::parse(bytes).map_err(|source| match source {
        ReadError::OtherFamily { found: found @ Family::FactoredBtf, .. } => not_drawn(path, found),
        source => Error::File { path: path.to_owned(), kind: "BTF", source },
    })
}

fn not_drawn(path: &Path, family: Family) -> Error {
    let why = "which only the library evaluates; encode it with --method nested to draw it";
    Error::Request(format!("{}: a {family}, {why}", path.display()))
}

/// Index of the material that is asked for by its name, or else by its number from 0.
#[must_use]
pub fn material_number(names: &[String], asked: &str) -> Option<usize> {
    let by_number = || asked.parse().ok().filter(|number| *number < names.len());
    names.iter().position(|name| name == asked).or_else(by_number)
}

/// Name of a file without folder and extension.
#[must_use]
pub fn stem(path: &Path) -> String {
    path.file_stem().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}
