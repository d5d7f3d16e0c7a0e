//! Methods of making BTF files, and sizes as each of them measures these.

use crate::btf::nested::{Extent, check_stages};
use crate::error::Result;
use crate::rate::Candidate;

/// Method of making a BTF file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Nested codebooks by shape-gain k-means from the top down, chosen anew from the bottom up; see [`crate::btf::nested`].
    Nested,
    /// Residual codewords of texels times a Tucker-coded angular basis; see [`crate::btf::factored`].
    Factored,
    /// Nested codebooks by pruning (Havran et al. 2010): a baseline; see [`crate::baseline::havran2010`].
    Havran2010,
}

/// Size of a BTF file, and with it the method that makes it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Size {
    /// Nested codebooks of some extent.
    Nested(Extent),
    /// Factors of at most so many bytes.
    Factored {
        /// Bytes of the file, at most.
        most_bytes: u64,
    },
    /// Nested codebooks by pruning.
    Havran2010 {
        /// Factor of the usual thresholds: larger ones give smaller files.
        looseness: f32,
    },
}

impl Size {
    /// Refuses sizes that no file has.
    pub(crate) fn check(&self) -> Result<()> {
        match self {
            Self::Nested(extent) => check_stages(extent.stages),
            Self::Factored { .. } | Self::Havran2010 { .. } => Ok(()),
        }
    }
}

/// Thresholds of pruning whose logarithms differ by less than this make no difference.
const SAME_LOOSENESS: f32 = 0.05;
/// Factors whose bytes differ by a smaller factor than this are not worth another file.
const SAME_BYTES: f64 = 1.02;

impl Candidate for Size {
    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_precision_loss,
        clippy::cast_sign_loss,
        reason = "millions, not negative"
    )]
    fn between(&self, next: &Self, part: f64) -> Option<Self> {
        match (self, next) {
            (Self::Nested(low), Self::Nested(high)) => low.between(high, part).map(Self::Nested),
            (Self::Factored { most_bytes: low }, Self::Factored { most_bytes: high }) => {
                let (low, high) = (*low as f64, *high as f64);
                let most_bytes = (low + part * (high - low)) as u64;
                (high > SAME_BYTES * low).then_some(Self::Factored { most_bytes })
            }
            (Self::Havran2010 { looseness: low }, Self::Havran2010 { looseness: high }) => {
                let looseness = low * (high / low).powf(part as f32);
                ((low / high).ln().abs() > SAME_LOOSENESS).then_some(Self::Havran2010 { looseness })
            }
            (Self::Nested(_) | Self::Factored { .. } | Self::Havran2010 { .. }, _) => None,
        }
    }
}
