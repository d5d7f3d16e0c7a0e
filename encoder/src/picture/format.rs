//! What pixels of pictures are.

use std::fmt::{Display, Formatter, Result};

/// What stands for a channel of a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PixelFormat {
    /// Display value (sRGB), 0 to 1, of 8 bits.
    Display8,
    /// Display value (sRGB), 0 to 1, of 16 bits.
    Display16,
    /// Linear float, of any range.
    Linear,
}

impl PixelFormat {
    /// Whether values are linear; display values otherwise.
    #[must_use]
    pub fn is_linear(self) -> bool {
        self == Self::Linear
    }

    /// Bytes of a channel in a file that is not compressed.
    #[must_use]
    pub fn bytes(self) -> u64 {
        match self {
            Self::Display8 => 1,
            Self::Display16 => 2,
            Self::Linear => 4,
        }
    }
}

/// For people.
impl Display for PixelFormat {
    fn fmt(&self, f: &mut Formatter<'_>) -> Result {
        f.write_str(match self {
            Self::Display8 => "8-bit sRGB",
            Self::Display16 => "16-bit sRGB",
            Self::Linear => "linear floats",
        })
    }
}
