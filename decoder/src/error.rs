//! The one error of this crate.

use core::fmt;

/// A part of the file, to say where something is wrong.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Section {
    /// Magic, version, size and section table.
    FileHeader,
    /// `BSSR`: size, pitch and model of a diffuse BSSRDF.
    BssrdfHeader,
    /// `PROF`: base scattering profiles.
    BaseProfiles,
    /// `PRFH`: base scattering profiles as half floats.
    HalfProfiles,
    /// `MIXR`: mixture ratios.
    MixtureRatios,
    /// `MIX8`: mixture ratios in 8 bits.
    SmallRatios,
    /// `BIDX`: base-material indices.
    BaseIndices,
    /// `PAIR`: palette of pairs of base materials.
    Pairs,
    /// `CODE`: number in the palette, and mixture ratio in 5 bits.
    Codes,
    /// `LSPP`: per-pixel local scattering profiles.
    LocalProfiles,
    /// `BTFH`: model, tone and grid of a BTF.
    BtfHeader,
    /// `MATS`: its materials.
    Materials,
    /// `BOOK`: sizes of its codebooks.
    Books,
    /// `P1S0` to `P6S3`: a codebook of luma.
    Codebook {
        /// 1, 2, 3, 4 or 6.
        book: u8,
        /// Additive stage, 0 to 3.
        stage: u8,
    },
    /// `MERG`: M, which joins P2 and I2.
    Merged,
    /// `CHR2`: I2.
    ChromaSlices2,
    /// `CHR1`: I1.
    ChromaSlices1,
    /// `CHRC`: C.
    Colours,
    /// `TINT`: tints of texels.
    Tints,
    /// `FACT`: numbers and steps of factors.
    Factors,
    /// `AXES`: axes of views and of lights.
    Axes,
    /// `CORE`: the core between the axes.
    Core,
    /// `WORD`: codewords of texels.
    Codewords,
    /// `INDX`: indices of texels.
    TexelIndices,
    /// A kind that this version does not know.
    Other([u8; 4]),
}

impl Section {
    /// The section of a four-letter kind.
    #[must_use]
    pub const fn from_kind(kind: [u8; 4]) -> Self {
        match &kind {
            b"BSSR" => Self::BssrdfHeader,
            b"PROF" => Self::BaseProfiles,
            b"PRFH" => Self::HalfProfiles,
            b"MIXR" => Self::MixtureRatios,
            b"MIX8" => Self::SmallRatios,
            b"BIDX" => Self::BaseIndices,
            b"PAIR" => Self::Pairs,
            b"CODE" => Self::Codes,
            b"LSPP" => Self::LocalProfiles,
            b"BTFH" => Self::BtfHeader,
            b"MATS" => Self::Materials,
            b"BOOK" => Self::Books,
            b"MERG" => Self::Merged,
            b"CHR2" => Self::ChromaSlices2,
            b"CHR1" => Self::ChromaSlices1,
            b"CHRC" => Self::Colours,
            b"TINT" => Self::Tints,
            b"FACT" => Self::Factors,
            b"AXES" => Self::Axes,
            b"CORE" => Self::Core,
            b"WORD" => Self::Codewords,
            b"INDX" => Self::TexelIndices,
            [b'P', book @ (b'1'..=b'4' | b'6'), b'S', stage @ b'0'..=b'3'] => {
                Self::Codebook { book: book.wrapping_sub(b'0'), stage: stage.wrapping_sub(b'0') }
            }
            _ => Self::Other(kind),
        }
    }

    /// The four letters that stand for this section in the file; the file header has none and gives zeros.
    #[must_use]
    pub const fn kind(self) -> [u8; 4] {
        match self {
            Self::FileHeader => [0; 4],
            Self::BssrdfHeader => *b"BSSR",
            Self::BaseProfiles => *b"PROF",
            Self::HalfProfiles => *b"PRFH",
            Self::MixtureRatios => *b"MIXR",
            Self::SmallRatios => *b"MIX8",
            Self::BaseIndices => *b"BIDX",
            Self::Pairs => *b"PAIR",
            Self::Codes => *b"CODE",
            Self::LocalProfiles => *b"LSPP",
            Self::BtfHeader => *b"BTFH",
            Self::Materials => *b"MATS",
            Self::Books => *b"BOOK",
            Self::Codebook { book, stage } => [b'P', b'0'.wrapping_add(book), b'S', b'0'.wrapping_add(stage)],
            Self::Merged => *b"MERG",
            Self::ChromaSlices2 => *b"CHR2",
            Self::ChromaSlices1 => *b"CHR1",
            Self::Colours => *b"CHRC",
            Self::Tints => *b"TINT",
            Self::Factors => *b"FACT",
            Self::Axes => *b"AXES",
            Self::Core => *b"CORE",
            Self::Codewords => *b"WORD",
            Self::TexelIndices => *b"INDX",
            Self::Other(kind) => kind,
        }
    }
}

impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::FileHeader => f.write_str("file header"),
            Self::BssrdfHeader => f.write_str("BSSR (material header)"),
            Self::BaseProfiles => f.write_str("PROF (base scattering profiles)"),
            Self::HalfProfiles => f.write_str("PRFH (base scattering profiles, half floats)"),
            Self::MixtureRatios => f.write_str("MIXR (mixture ratios)"),
            Self::SmallRatios => f.write_str("MIX8 (mixture ratios, 8 bits)"),
            Self::BaseIndices => f.write_str("BIDX (base-material indices)"),
            Self::Pairs => f.write_str("PAIR (palette of pairs)"),
            Self::Codes => f.write_str("CODE (palette codes)"),
            Self::LocalProfiles => f.write_str("LSPP (local scattering profiles)"),
            Self::BtfHeader => f.write_str("BTFH (BTF header)"),
            Self::Materials => f.write_str("MATS (materials)"),
            Self::Books => f.write_str("BOOK (sizes of codebooks)"),
            Self::Codebook { book, stage } => write!(f, "P{book}S{stage} (codebook P{book}, stage {stage})"),
            Self::Merged => f.write_str("MERG (codebook M)"),
            Self::ChromaSlices2 => f.write_str("CHR2 (codebook I2)"),
            Self::ChromaSlices1 => f.write_str("CHR1 (codebook I1)"),
            Self::Colours => f.write_str("CHRC (codebook C)"),
            Self::Tints => f.write_str("TINT (tints of texels)"),
            Self::Factors => f.write_str("FACT (numbers and steps of factors)"),
            Self::Axes => f.write_str("AXES (axes of views and lights)"),
            Self::Core => f.write_str("CORE (core between axes)"),
            Self::Codewords => f.write_str("WORD (codewords of texels)"),
            Self::TexelIndices => f.write_str("INDX (indices of texels)"),
            Self::Other(kind) => write!(f, "{}", kind.escape_ascii()),
        }
    }
}

/// Why a file was refused. `offset` always counts bytes from the start of the file.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum ReadError {
    /// The first eight bytes are not those of a `.subsurf` file.
    NotSubsurf,
    /// Written by a later, incompatible version of the format.
    NewerVersion {
        /// Major version of the file.
        major: u16,
        /// Minor version of the file.
        minor: u16,
    },
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
        /// Which one.
        section: Section,
    },
    /// A section that this content needs is not there.
    Missing {
        /// Which one.
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
        /// Which one.
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
        /// Where.
        offset: u64,
        /// Its value.
        value: u32,
    },
    /// A number is not finite or outside its range.
    BadNumber {
        /// The section it stands in.
        section: Section,
        /// Where.
        offset: u64,
        /// Its value.
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
        /// Where.
        offset: u64,
        /// The index.
        index: u32,
        /// Number of base materials, or of pairs.
        len: u32,
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
                write!(f, "{section}: byte {offset}: {value} is not in {min} to {max}")
            }
            Self::IndexOutOfRange { section, offset, index, len } => {
                write!(f, "{section}: byte {offset}: index {index}, but the table has {len} entries")
            }
        }
    }
}
