//! Kinds of sections: their four bytes and what they hold.

use core::fmt;

/// The enum and its conversions from one list of sections, some of which belong to a feature.
macro_rules! sections {
    ($($(#[$about:meta])* $name:ident = $kind:literal, $content:literal $(, if $feature:literal)?;)*) => {
        /// A part of the file, to find it and to say where something is wrong.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        #[non_exhaustive]
        pub enum Section {
            /// Magic, version, size and section table.
            FileHeader,
            $($(#[$about])* $(#[cfg(feature = $feature)])? $name,)*
            /// `P1S0` to `P6S3`: a codebook of luma.
            Codebook {
                /// 1, 2, 3, 4 or 6.
                book: u8,
                /// Additive stage, 0 to 3.
                stage: u8,
            },
            /// A kind that this version does not know.
            Other([u8; 4]),
        }

        /// All kinds but those of codebooks. A table, since code that compares one after the other is three times as large.
        const KINDS: &[([u8; 4], Section)] = &[$($(#[cfg(feature = $feature)])? (*$kind, Section::$name),)*];

        impl Section {
            /// The section of a kind.
            #[must_use]
            pub fn from_kind(kind: [u8; 4]) -> Self {
                match kind {
                    [b'P', book @ (b'1'..=b'4' | b'6'), b'S', stage @ b'0'..=b'3'] => {
                        Self::Codebook { book: book.wrapping_sub(b'0'), stage: stage.wrapping_sub(b'0') }
                    }
                    _ => KINDS.iter().find(|(known, _)| *known == kind).map_or(Self::Other(kind), |(_, section)| *section),
                }
            }

            /// The four bytes that stand for this section in the file; the file header has none and gives zeros.
            #[must_use]
            pub fn kind(self) -> [u8; 4] {
                match self {
                    Self::Codebook { book, stage } => [b'P', b'0'.wrapping_add(book), b'S', b'0'.wrapping_add(stage)],
                    Self::Other(kind) => kind,
                    _ => KINDS.iter().find(|(_, section)| *section == self).map_or([0; 4], |(kind, _)| *kind),
                }
            }

            /// Whether a reader that does not know the section must refuse the file; it may skip those whose first letter is lower-case.
            #[must_use]
            pub fn is_critical(self) -> bool {
                let [first, ..] = self.kind();
                !first.is_ascii_lowercase()
            }
        }

        impl fmt::Display for Section {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                let content = match self {
                    Self::FileHeader => return f.write_str("file header"),
                    $($(#[cfg(feature = $feature)])? Self::$name => $content,)*
                    Self::Codebook { book, stage } => {
                        return write!(f, "P{book}S{stage} (codebook P{book}, stage {stage})");
                    }
                    Self::Other(kind) => return write!(f, "{}", kind.escape_ascii()),
                };
                write!(f, "{} ({content})", self.kind().escape_ascii())
            }
        }
    };
}

sections! {
    /// `meta`: who made what, and from what.
    Metadata = b"meta", "metadata";
    /// `BSSR`: size, pitch and model of a diffuse BSSRDF.
    BssrdfHeader = b"BSSR", "material header";
    /// `PROF`: base scattering profiles.
    BaseProfiles = b"PROF", "base scattering profiles";
    /// `PRFH`: base scattering profiles as half floats.
    HalfProfiles = b"PRFH", "base scattering profiles, half floats";
    /// `MIXR`: mixture ratios.
    MixtureRatios = b"MIXR", "mixture ratios";
    /// `MIX8`: mixture ratios in 8 bits.
    SmallRatios = b"MIX8", "mixture ratios, 8 bits";
    /// `BIDX`: base-material indices.
    BaseIndices = b"BIDX", "base-material indices";
    /// `PAIR`: palette of pairs of base materials.
    Pairs = b"PAIR", "palette of pairs";
    /// `CODE`: number in the palette, and mixture ratio in 5 bits.
    Codes = b"CODE", "palette codes";
    /// `LSPP`: per-pixel local scattering profiles.
    LocalProfiles = b"LSPP", "local scattering profiles";
    /// `sepb`: separable basis.
    SeparableBasis = b"sepb", "separable basis";
    /// `KERN`: sizes, signs and units of a kernel.
    KernelHeader = b"KERN", "kernel header";
    /// `KOFF`: offsets of taps.
    KernelOffsets = b"KOFF", "offsets of taps";
    /// `KWGT`: weights of taps.
    KernelWeights = b"KWGT", "weights of taps";
    /// `TAIL`: tail of a diffusion profile.
    KernelTail = b"TAIL", "tail of the profile";
    /// `twog`: the two Gaussians that a kernel was made of.
    TwoGaussians = b"twog", "two Gaussians";
    /// `XFER`: sizes, units and mesh of a transfer.
    TransferHeader = b"XFER", "transfer header", if "transfer";
    /// `XDIR`: directions towards the lights of a transfer.
    Lights = b"XDIR", "directions of lights", if "transfer";
    /// `XAXS`: axes of light that clusters share.
    LightAxes = b"XAXS", "axes of light", if "transfer";
    /// `XRNG`: offsets and steps of what clusters store.
    ClusterRanges = b"XRNG", "ranges of clusters", if "transfer";
    /// `XMEA`: means of clusters.
    ClusterMeans = b"XMEA", "means of clusters", if "transfer";
    /// `XBAS`: principal components of clusters.
    ClusterBases = b"XBAS", "components of clusters", if "transfer";
    /// `XVTX`: cluster and coefficients of vertices.
    VertexCodes = b"XVTX", "codes of vertices", if "transfer";
    /// `BTFH`: model, colour encoding and grid of a BTF.
    BtfHeader = b"BTFH", "BTF header";
    /// `MATS`: names and sizes of a BTF's materials.
    Materials = b"MATS", "materials";
    /// `BOOK`: sizes of the nested codebooks.
    CodebookSizes = b"BOOK", "sizes of codebooks";
    /// `MERG`: codebook M, which joins P2 and I2.
    Merged = b"MERG", "codebook M";
    /// `CHR2`: codebook I2, chroma over α.
    ChromaSlices2 = b"CHR2", "codebook I2";
    /// `CHR1`: codebook I1, chroma over sin β.
    ChromaSlices1 = b"CHR1", "codebook I1";
    /// `CHRC`: codebook C, values of chroma.
    Colours = b"CHRC", "codebook C";
    /// `TINT`: tints of texels.
    Tints = b"TINT", "tints of texels";
    /// `FACT`: sizes and quantisation steps of a Tucker decomposition.
    TuckerHeader = b"FACT", "numbers and steps of factors";
    /// `AXES`: factors of views and of lights.
    Axes = b"AXES", "axes of views and lights";
    /// `CORE`: core tensor between the axes, entropy-coded.
    Core = b"CORE", "core between axes";
    /// `WORD`: codewords of texels, entropy-coded.
    Codewords = b"WORD", "codewords of texels";
    /// `INDX`: indices of codewords, for each texel.
    TexelIndices = b"INDX", "indices of texels";
}
