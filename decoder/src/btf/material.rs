//! `MATS`: names and sizes of the materials of a BTF file.

use crate::container::origin::Origin;
use crate::container::record::{Field, record};
use crate::error::ReadError;
use core::mem::offset_of;

/// Bytes of a material in `MATS`.
pub const MATERIAL_BYTES: usize = size_of::<MaterialRecord>();
/// Bytes of a material's name.
pub const NAME_BYTES: usize = 24;
/// Largest number of mipmap levels.
const MAX_LEVELS: u32 = 16;

record! {
    /// A material in `MATS` (`FORMAT.md`, section 4.2).
    MaterialRecord {
        name: [u8; NAME_BYTES],
        width: u16,
        height: u16,
        levels: u8,
        reserved: [u8; 3],
    }
}

/// Name, size and mipmap levels of one material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Material {
    /// Name in UTF-8, filled up with zeros.
    pub name: [u8; NAME_BYTES],
    /// Texels in x, 1 to 65,535.
    pub width: u16,
    /// Texels in y, 1 to 65,535.
    pub height: u16,
    /// Mipmap levels, 1 to 16; each is half as large as the one before it, rounded down, and at least one texel.
    pub levels: u8,
}

impl Material {
    /// Material as it stands in the file.
    #[must_use]
    pub fn to_bytes(&self) -> [u8; MATERIAL_BYTES] {
        let Self { name, width, height, levels } = *self;
        MaterialRecord { name, width, height, levels, reserved: [0; 3] }.to_bytes()
    }

    /// Material from the file, unchecked.
    pub(super) fn from_bytes(bytes: &[u8; MATERIAL_BYTES]) -> Self {
        let MaterialRecord { name, width, height, levels, .. } = MaterialRecord::from_bytes(bytes);
        Self { name, width, height, levels }
    }

    /// Refuses what is out of range; the record stands at `origin`.
    pub(super) fn check(&self, origin: Origin) -> Result<(), ReadError> {
        use MaterialRecord as R;
        for (at, side) in [(offset_of!(R, width), self.width), (offset_of!(R, height), self.height)] {
            origin.integer(at, side, 1..=u16::MAX.into())?;
        }
        origin.integer(offset_of!(R, levels), self.levels, 1..=MAX_LEVELS)?;
        Ok(())
    }

    /// Name, as far as it is UTF-8.
    #[must_use]
    pub fn name(&self) -> &str {
        let name = self.name.split(|byte| *byte == 0).next().unwrap_or(&[]);
        match core::str::from_utf8(name) {
            Ok(name) => name,
            Err(error) => {
                name.get(..error.valid_up_to()).and_then(|name| core::str::from_utf8(name).ok()).unwrap_or("")
            }
        }
    }

    /// Width and height of a mipmap level in texels.
    #[must_use]
    pub fn size(&self, level: u8) -> [u32; 2] {
        [self.width, self.height].map(|side| u32::from(side).wrapping_shr(level.min(16).into()).max(1))
    }

    /// Number of texels in the first `levels` levels.
    #[must_use]
    pub fn texels(&self, levels: u8) -> u32 {
        let area = |level| {
            let [width, height] = self.size(level);
            width.saturating_mul(height)
        };
        (0..levels.min(self.levels)).fold(0, |sum: u32, level| sum.saturating_add(area(level)))
    }
}
