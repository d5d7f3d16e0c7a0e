//! A file of any family from bytes as they come: from flash over SPI, from a stream of assets.
//!
//! [`PushReader`] takes chunks of any size and hands out [`Piece`]s: headers, and rows of tables as soon as each is whole. It keeps the section
//! table and one row, in a buffer whose size is a constant of its type, and nothing else of the file.
//!
//! ```
//! use subsurf_decoder::push::{Piece, PushReader};
//! use subsurf_decoder::{ReadError, Section};
//!
//! /// Sum of the mixture ratios of a patch, from a file of which 64 bytes at a time are in memory.
//! fn sum_of_ratios(flash: &[u8]) -> Result<f32, ReadError> {
//!     use subsurf_decoder::container::bytes::F32Le;
//!
//!     let mut sum = 0.0;
//!     let mut reader = PushReader::<1024>::new();
//!     for chunk in flash.chunks(64) {
//!         reader.push(chunk, |piece| match piece {
//!             Piece::Row(row) if row.section == Section::MixtureRatios => {
//!                 sum += F32Le::new(row.bytes).iter().sum::<f32>();
//!             }
//!             _ => {}
//!         })?;
//!     }
//!     reader.finish()?;
//!     Ok(sum)
//! }
//! # assert!(sum_of_ratios(b"not a file").is_err());
//! ```
//!
//! # Rows
//!
//! | section | a row is |
//! |---|---|
//! | `BSSR`, `BTFH`, `KERN`, `XFER` | all of it: [`Piece::Bssrdf`], [`Piece::Btf`], [`Piece::Kernel`], [`Piece::Transfer`] |
//! | `PROF`, `PRFH` | a node of a material, red, green, blue: row m S + h is node h of material m |
//! | `MIXR`, `MIX8`, `BIDX`, `CODE` | a row of pixels: row k · height + y of plane k |
//! | `LSPP` | a row of pixels of one channel of a node: row (3 h + c) · height + y |
//! | `PAIR`, `CHRC`, `TINT` | 64 entries of two bytes; what is left, at the end |
//! | `sepb` | [`Piece::Basis`], then all σ, then the A weights of a pair, for every pair, then rgb of a factor |
//! | `KOFF`, `twog` | all of it |
//! | `KWGT` | a term, `[tap][rgb]` |
//! | `TAIL` | a node, red, green, blue |
//! | `XDIR`, `XRNG`, `XVTX` | a light; a cluster, `[1 + K][2]`; a vertex |
//! | `XAXS` | the axes of a light in one channel: row c · L + j |
//! | `XMEA`, `XBAS` | the axes of a cluster; of a component, row m · K + k |
//! | `MATS` | a material: [`Piece::Material`] |
//! | `BOOK` | all of it: [`Piece::Codebooks`] |
//! | `P6Ss`, `P4Ss`, `P3Ss`, `MERG`, `CHR2`, `CHR1` | 64 items, from the lowest bit on; what is left, at the end |
//! | `P2Ss` | the lowest eight bits of n_α codes, for every entry, then 64 items as above |
//! | `P1Ss` | n_β values and the exponent |
//! | `FACT` | [`Piece::Tucker`], then `ratio_steps`, `column_scales`, `core_steps`, `view_scales`, `light_scales` |
//! | `AXES` | an axis |
//! | `CORE`, `WORD` | 128 bytes of the code; what is left, at the end |
//! | `INDX` | a texel |
//!
//! Fill is not handed out. Sections that the reader of whole files does not look at are passed over.
//!
//! # What is checked
//!
//! All that [`File::parse`](crate::File::parse) checks, by the same code, but one thing: whether the ratios of a pixel add up to 1 where K is 3 or 5. They are a plane
//! apart, so that no buffer of a fixed size has them together. Who keeps K rows of ratios can add them up.
//!
//! CRCs are compared when a section has passed, which [`Piece::End`] says. Before that, rows of damaged bytes may have been handed out, as long as their values are
//! allowed. The last row of a section waits for the CRC, and so do headers. Nothing is certain of the file as a whole before [`PushReader::finish`].
//!
//! A file is refused for the reason that `File::parse` has, if only one thing is wrong. If there are more, another one may be named: sections are checked as
//! they come, the sizes of all of them before any value, and a file's length against what came of it at the end.
//!
//! # Order of sections
//!
//! Rows need the header of their family; those of nested codebooks `MATS` and then `BOOK`, too, those of a Tucker decomposition `MATS` and then `FACT`. Files that
//! have them later, which `File::parse` reads, are refused with [`ReadError::OutOfOrder`].

pub(crate) mod piece;
mod plan;
pub(crate) mod rows;
mod state;

pub use piece::{Piece, Row};

use crate::container::Crc;
use crate::error::ReadError;
use heapless::Vec;
use state::State;

/// Reader of a file whose bytes are pushed, with a buffer of `N` bytes.
///
/// `N` must be at least 28, 24 for each section of the file and the bytes of its longest row together: for a BSSRDF of K base materials in five sections 148 and four for each
/// pixel of a row, 1,064 for 229 pixels. Beside the buffer a reader has less than 512 bytes.
#[derive(Clone, Debug)]
pub struct PushReader<const N: usize> {
    buffer: Vec<u8, N>,
    state: State,
    failed: Option<ReadError>,
}

impl<const N: usize> Default for PushReader<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> PushReader<N> {
    /// Reader at the start of a file, which compares CRCs.
    #[must_use]
    pub const fn new() -> Self {
        Self::with_crc(Crc::Check)
    }

    /// [`Self::new`] with a choice about the sections' CRC-32.
    #[must_use]
    pub const fn with_crc(crc: Crc) -> Self {
        Self { buffer: Vec::new(), state: State::new(crc), failed: None }
    }

    /// Takes the next bytes of the file, any number of them, and hands out what they complete. Bytes beyond the file are ignored.
    ///
    /// # Errors
    /// The first thing that is wrong; [`ReadError::BufferTooSmall`] says what `N` must be at least. Once it has failed, the reader hands out
    /// nothing and repeats its error.
    pub fn push(&mut self, bytes: &[u8], mut on_piece: impl FnMut(Piece<'_>)) -> Result<(), ReadError> {
        if self.failed.is_none() {
            // Without `N` and the caller's type: one copy of the code.
            self.failed = self.state.push(self.buffer.as_mut_view(), bytes, &mut on_piece).err();
        }
        self.failed.map_or(Ok(()), Err)
    }

    /// Whether all bytes of the file have passed, so that no more need be fetched.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.failed.is_none() && self.state.is_complete()
    }

    /// Says that no bytes follow.
    ///
    /// # Errors
    /// [`ReadError::Truncated`] where some are missing, and the error that [`Self::push`] has given.
    pub fn finish(&self) -> Result<(), ReadError> {
        self.failed.map_or(Ok(()), Err).and_then(|()| self.state.end(&self.buffer))
    }
}
