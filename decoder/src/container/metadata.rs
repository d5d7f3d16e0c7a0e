//! The `meta` section: what people want to know of a file, as keys and values (`FORMAT.md`, section 1.2).

use super::bytes::slice_at;
use super::record::{Field, record};

/// Bytes of the longest key.
pub const MAX_KEY_BYTES: usize = u8::MAX as usize;
/// Bytes of the longest value.
pub const MAX_VALUE_BYTES: usize = u16::MAX as usize;

record! {
    /// What every entry begins with.
    EntryHeader {
        key_bytes: u8,
        reserved: u8,
        value_bytes: u16,
    }
}

/// What stands before the key and the value of an entry, for writers; `None` for lengths out of range: a key has 1 to 255 bytes.
#[must_use]
pub fn entry_header(key: &str, value: &str) -> Option<[u8; size_of::<EntryHeader>()]> {
    let key_bytes = u8::try_from(key.len()).ok().filter(|bytes| *bytes > 0)?;
    let value_bytes = u16::try_from(value.len()).ok()?;
    Some(EntryHeader { key_bytes, reserved: 0, value_bytes }.to_bytes())
}

/// Keys and values of a file, in its order: an iterator over both as text, control characters of strangers in it.
///
/// Usual keys are `name`, `author`, `licence`, `source` and `tool`. Of a key that stands twice, which writers must not do, the last counts. Ends
/// with the first entry that leads outside; skips those without a key and what is not UTF-8.
#[derive(Clone, Debug)]
pub struct Metadata<'a>(&'a [u8]);

impl<'a> Metadata<'a> {
    /// Entries of a section.
    pub(super) fn new(section: &'a [u8]) -> Self {
        Self(section)
    }

    /// Bytes of the next key and value; moves on.
    fn advance(&mut self) -> Option<[&'a [u8]; 2]> {
        let (header, rest) = self.0.split_first_chunk::<{ size_of::<EntryHeader>() }>()?;
        let EntryHeader { key_bytes, value_bytes, .. } = EntryHeader::from_bytes(header);
        let [key_bytes, value_bytes] = [u64::from(key_bytes), u64::from(value_bytes)];
        let key = slice_at(rest, 0, key_bytes)?;
        let value = slice_at(rest, key_bytes, value_bytes)?;
        self.0 = rest.get(key.len()..)?.get(value.len()..)?;
        Some([key, value])
    }
}

impl<'a> Iterator for Metadata<'a> {
    type Item = (&'a str, &'a str);

    fn next(&mut self) -> Option<Self::Item> {
        loop {
            let [key, value] = self.advance()?.map(core::str::from_utf8);
            if let (Ok(key), Ok(value)) = (key, value)
                && !key.is_empty()
            {
                return Some((key, value));
            }
        }
    }
}
