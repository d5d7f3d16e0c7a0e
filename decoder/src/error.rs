//! The one error of this crate.

use crate::decimal::Decimal;
use crate::family::Family;
use crate::section::Section;
use core::fmt;

/// Why a file was refused. `offset` always counts bytes from the start of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReadError {
    /// The first eight bytes are not those of a `.subsurf` file.
    NotSubsurf,
    /// Of another major version of the format.
    NewerVersion {
        /// Major version of the file.
        major: u16,
        /// Minor version of the file.
        minor: u16,
    },
    /// A section that must not be skipped, and that this version does not know: of a later version, or of a family that was left out.
    NewerSection {
        /// The section.
        section: Section,
    },
    /// The headers of two families in one file.
    TwoFamilies {
        /// Headers that are there.
        headers: [Section; 2],
    },
    /// A file of another family than the one that was asked for.
    OtherFamily {
        /// Family of the file.
        found: Family,
        /// Family that the caller reads.
        expected: Family,
    },
    /// The container is sound, but has the header of no family that this version knows.
    UnknownContent,
    /// The file ends too early.
    Truncated {
        /// The part that is cut.
        section: Section,
        /// Bytes that should be there, from the start of the file.
        need_bytes: u64,
        /// Bytes that are there.
        have_bytes: u64,
    },
    /// The number of sections is zero or above the limit.
    SectionCount {
        /// Number in the file.
        count: u32,
        /// Largest number allowed.
        limit: u32,
    },
    /// A section begins before the one ahead of it ends, or before the section table ends.
    Overlap {
        /// The later of the two.
        section: Section,
        /// Where it begins.
        offset: u64,
        /// Where it may begin at the earliest.
        earliest: u64,
    },
    /// A section is there twice.
    Duplicate {
        /// The section.
        section: Section,
    },
    /// A section that this content needs is not there.
    Missing {
        /// The section.
        section: Section,
    },
    /// A checksum does not fit: the file was damaged.
    Checksum {
        /// The damaged part.
        section: Section,
        /// CRC-32 that the file states.
        stored: u32,
        /// CRC-32 of the bytes that are there.
        computed: u32,
    },
    /// A section's size does not follow from the header.
    WrongSize {
        /// The section.
        section: Section,
        /// Bytes that the header asks for.
        need_bytes: u64,
        /// Bytes that the section has.
        have_bytes: u64,
    },
    /// A code or count in a header has a value that this version does not allow.
    BadField {
        /// The section it stands in.
        section: Section,
        /// Its first byte.
        offset: u64,
        /// Its value.
        value: u32,
    },
    /// A number is not finite or outside its range.
    BadNumber {
        /// The section it stands in.
        section: Section,
        /// Its first byte.
        offset: u64,
        /// Its value, or what was computed from the numbers that begin there: a squared length, a sum.
        value: f32,
        /// Smallest value allowed.
        min: f32,
        /// Largest value allowed.
        max: f32,
    },
    /// An index leads outside the table of profiles, or of pairs.
    IndexOutOfRange {
        /// The section it stands in.
        section: Section,
        /// Its first byte.
        offset: u64,
        /// The index.
        index: u32,
        /// Number of base materials, or of pairs.
        len: u32,
    },
    /// A section stands before the one that says what its rows are, which [`PushReader`](crate::push::PushReader) must know by then.
    #[cfg(feature = "push")]
    OutOfOrder {
        /// The section.
        section: Section,
        /// What must stand before it.
        needs: Section,
    },
    /// The buffer of a [`PushReader`](crate::push::PushReader) is too small for a row of the file, or for its section table.
    #[cfg(feature = "push")]
    BufferTooSmall {
        /// The section that the row belongs to.
        section: Section,
        /// Bytes that the buffer must hold for it.
        need_bytes: u64,
        /// Bytes that it holds.
        have_bytes: u64,
    },
}

impl core::error::Error for ReadError {}

impl fmt::Display for ReadError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match *self {
            Self::NotSubsurf => f.write_str("not a .subsurf file (its first 8 bytes are others)"),
            Self::NewerVersion { major, minor } => {
                write!(f, "format version {major}.{minor}; this reader knows version 1")
            }
            Self::NewerSection { section } => {
                write!(f, "{section}: is not known: made by a newer version, or of a family left out")
            }
            Self::TwoFamilies { headers: [first, second] } => write!(f, "{first} and {second} in one file"),
            Self::OtherFamily { found, expected } => write!(f, "a {found}, not a {expected}"),
            Self::UnknownContent => f.write_str("a .subsurf file whose content this version does not know"),
            Self::Truncated { section, need_bytes, have_bytes } => {
                write!(f, "{section}: file is cut, needs {need_bytes} bytes, has {have_bytes}")
            }
            Self::SectionCount { count, limit } => {
                write!(f, "file header: {count} sections, allowed are 1 to {limit}")
            }
            Self::Overlap { section, offset, earliest } => {
                write!(f, "{section}: begins at byte {offset}, inside what ends at byte {earliest}")
            }
            Self::Duplicate { section } => write!(f, "{section}: is there twice"),
            Self::Missing { section } => write!(f, "{section}: is missing"),
            Self::Checksum { section, stored, computed } => {
                write!(f, "{section}: is damaged, CRC-32 {computed:08x}, stored {stored:08x}")
            }
            Self::WrongSize { section, need_bytes, have_bytes } => {
                write!(f, "{section}: has {have_bytes} bytes, the header asks for {need_bytes}")
            }
            Self::BadField { section, offset, value } => {
                write!(f, "{section}: byte {offset}: value {value} is not allowed")
            }
            Self::BadNumber { section, offset, value, min, max } => {
                let [value, min, max] = [value, min, max].map(Decimal);
                write!(f, "{section}: byte {offset}: {value} is not in {min} to {max}")
            }
            Self::IndexOutOfRange { section, offset, index, len } => {
                write!(f, "{section}: byte {offset}: index {index}, but the table has {len} entries")
            }
            #[cfg(feature = "push")]
            Self::OutOfOrder { section, needs } => write!(f, "{section}: stands before {needs}, which is needed first"),
            #[cfg(feature = "push")]
            Self::BufferTooSmall { section, need_bytes, have_bytes } => {
                write!(f, "{section}: takes a buffer of {need_bytes} bytes, there are {have_bytes}")
            }
        }
    }
}
