//! Material files: reading and parsing those that can be drawn.

use std::path::Path;

use subsurf_decoder::btf::{Catalog, Model};
use subsurf_decoder::container::{Container, Crc};
use subsurf_decoder::{Bssrdf, Btf, ReadError, Section};

use crate::error::{Error, Result};

/// Material of a file that can be drawn.
#[derive(Clone, Copy)]
#[allow(clippy::large_enum_variant, reason = "one at a time")]
pub enum Content<'a> {
    /// A translucent material.
    Bssrdf(Bssrdf<'a>),
    /// Bidirectional texture functions in nested codebooks.
    Btf(Btf<'a>),
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
/// [`Error::File`] for broken files, [`Error::Request`] for a BTF in factors, which is not drawn.
pub fn parse<'a>(path: &Path, bytes: &'a [u8]) -> Result<Content<'a>> {
    let wrong = |kind, source: ReadError| Error::File { path: path.to_owned(), kind, source };
    let container = Container::parse(bytes).map_err(|error| wrong("material", error))?;
    if !container.entries().any(|entry| entry.section == Section::BtfHeader) {
        let material = Bssrdf::parse_with(bytes, Crc::Check);
        return material.map(Content::Bssrdf).map_err(|error| wrong("material", error));
    }
    parse_btf(path, bytes).map(Content::Btf)
}

/// [`parse`] of a file that has to be a BTF.
///
/// # Errors
/// As [`parse`].
pub fn parse_btf<'a>(path: &Path, bytes: &'a [u8]) -> Result<Btf<'a>> {
    Btf::parse_with(bytes, Crc::Check).map_err(|source| {
        match Catalog::parse(bytes, Crc::Check).map(|catalog| catalog.header().model) {
            Ok(Model::Factored) => Error::Request(format!(
                "{}: a BTF of factors, which only the library evaluates; encode it with --method nested to draw it",
                path.display()
            )),
            _ => Error::File { path: path.to_owned(), kind: "BTF", source },
        }
    })
}

/// Index of the material that is asked for by its name, or else by its number from 0.
#[must_use]
pub fn material_number(names: &[String], asked: &str) -> Option<usize> {
    let by_number = || asked.parse().ok().filter(|number| *number < names.len());
    names.iter().position(|name| name == asked).or_else(by_number)
}
