//! A basis in a file that is there.

use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::container::ENTRY_BYTES;
use subsurf_decoder::{Bssrdf, Section};

use super::choose::{BasisOptions, LARGEST, fit_basis};
use super::fitted::FittedBasis;
use crate::bssrdf::options;
use crate::capture::Capture;
use crate::error::{Error, Result};
use crate::file::container;
use crate::progress::Progress;

/// The same file with a separable basis, in place of one that it may have; all other sections stay as they are.
///
/// # Errors
/// [`Error::Request`] if the bytes are no BSSRDF file, or as [`fit_basis`].
pub fn add_basis(file: &[u8], options: &BasisOptions, progress: &dyn Progress) -> Result<Vec<u8>> {
    let material = Bssrdf::parse(file).map_err(|error| Error::Request(error.to_string()))?;
    with_basis(file, &fit_basis(&material, options, progress)?)
}

/// The same file with these numbers as its basis.
///
/// # Errors
/// [`Error::Request`] if the bytes are no file; [`Error::OwnOutput`] if the decoder refuses the result.
pub fn with_basis(file: &[u8], basis: &FittedBasis) -> Result<Vec<u8>> {
    container::with_section(file, Section::SeparableBasis, Some(&basis.to_bytes()))
}

/// Bytes that a basis adds to a file of a capture, at most.
///
/// # Errors
/// [`Error::Request`] for S out of range.
pub fn basis_bytes(capture: &Capture, samples: Option<usize>) -> Result<u64> {
    let samples = u16::try_from(options::geometry(capture, samples)?.nodes).expect("at most 4,096 nodes");
    let [terms, gaussians] = LARGEST;
    // With the fill before it.
    Ok(ENTRY_BYTES as u64 + BasisSize { terms, gaussians }.section_bytes(samples) + 3)
}
