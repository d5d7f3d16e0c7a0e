//! From a place within a section to an error that counts from the start of the file.

use crate::error::ReadError;
use crate::section::Section;
use core::ops::RangeInclusive;

/// First byte of a section, or of a record within it. Checks values, and says where one is wrong.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Origin {
    /// The section that the values stand in.
    pub(crate) section: Section,
    /// Bytes from the start of the file.
    pub(crate) offset: u64,
}

impl Origin {
    /// The place `at` bytes further on.
    pub(crate) fn at(self, at: usize) -> Self {
        Self { offset: self.offset.saturating_add(at as u64), ..self }
    }

    /// Place of item number `item`, for items of `item_bytes`.
    pub(crate) fn at_item(self, item: usize, item_bytes: usize) -> Self {
        self.at(item.saturating_mul(item_bytes))
    }

    /// Error of a field, `at` bytes from here, whose value is not allowed.
    pub(crate) fn bad_field(self, at: usize, value: impl Into<u32>) -> ReadError {
        ReadError::BadField { section: self.section, offset: self.at(at).offset, value: value.into() }
    }

    /// Error of the number that stands here.
    pub(crate) fn bad_number(self, value: f32, [min, max]: [f32; 2]) -> ReadError {
        ReadError::BadNumber { section: self.section, offset: self.offset, value, min, max }
    }

    /// Error of the index that stands here, into a table of `len` entries.
    pub(crate) fn bad_index(self, index: u32, len: u32) -> ReadError {
        ReadError::IndexOutOfRange { section: self.section, offset: self.offset, index, len }
    }

    /// Value of an integer field, `at` bytes from here, that must lie in `range`.
    pub(crate) fn integer<T: Copy + Into<u32>>(
        self,
        at: usize,
        value: T,
        range: RangeInclusive<u32>,
    ) -> Result<T, ReadError> {
        if range.contains(&value.into()) { Ok(value) } else { Err(self.bad_field(at, value)) }
    }

    /// Value of a field of real numbers, `at` bytes from here, that must lie in `[min, max]`. NaN lies in no range.
    pub(crate) fn number(self, at: usize, value: f32, range: [f32; 2]) -> Result<f32, ReadError> {
        let [min, max] = range;
        if (min..=max).contains(&value) { Ok(value) } else { Err(self.at(at).bad_number(value, range)) }
    }
}
