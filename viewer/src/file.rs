//! Material files: reading and parsing those that can be drawn.

use std::fs::File as Disk;
use std::io::Read;
use std::path::Path;

use subsurf_decoder::container::MAGIC;
use subsurf_decoder::{Bssrdf, Family, File, Kernel, NestedBtf, ReadError, Transfer};

use crate::error::{Error, Result};

/// Material of a file that can be drawn.
#[derive(Clone, Copy)]
#[allow(clippy::large_enum_variant, reason = "one at a time")]
pub enum DrawnMaterial<'a> {
    /// A translucent material.
    Bssrdf(Bssrdf<'a>),
    /// Bidirectional texture functions in nested codebooks.
    Btf(NestedBtf<'a>),
    /// A homogeneous material with its separable kernel.
    Kernel(Kernel<'a>),
    /// Scattering precomputed for the vertices of one mesh.
    Transfer(Transfer<'a>),
}

/// Bytes of a material file. No more than its beginning is read of anything else, however long it is.
///
/// # Errors
/// [`Error::Open`] if the system refuses, [`Error::File`] if the file does not begin as one.
pub fn read(path: &Path) -> Result<Vec<u8>> {
    let open = |source| Error::Open { path: path.to_owned(), source };
    let mut file = Disk::open(path).map_err(open)?;
    let mut bytes = Vec::new();
    file.by_ref().take(MAGIC.len() as u64).read_to_end(&mut bytes).map_err(open)?;
    if bytes.len() == MAGIC.len() && bytes != MAGIC {
        return Err(Error::File { path: path.to_owned(), kind: "material", source: ReadError::NotSubsurf });
    }
    file.read_to_end(&mut bytes).map_err(open)?;
    Ok(bytes)
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
        subsurf_decoder::Content::Kernel(kernel) => Ok(DrawnMaterial::Kernel(kernel)),
        subsurf_decoder::Content::Transfer(transfer) => Ok(DrawnMaterial::Transfer(transfer)),
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
