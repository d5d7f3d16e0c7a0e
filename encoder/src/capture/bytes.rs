//! Little-endian fields, one after another, of files that nobody vouches for.

use std::path::Path;

use crate::error::{Error, Result};

/// A file and how far it has been read.
pub(in crate::capture) struct Bytes<'a> {
    path: &'a Path,
    file: &'a [u8],
    at: usize,
}

impl<'a> Bytes<'a> {
    pub(in crate::capture) fn new(path: &'a Path, file: &'a [u8]) -> Self {
        Self { path, file, at: 0 }
    }

    /// Offset of the next byte.
    pub(in crate::capture) fn at(&self) -> usize {
        self.at
    }

    /// Bytes that are left.
    pub(in crate::capture) fn rest(&self) -> &'a [u8] {
        &self.file[self.at..]
    }

    /// Bytes of something that an error can name.
    pub(in crate::capture) fn take(&mut self, bytes: u64, what: &str) -> Result<&'a [u8]> {
        let rest = self.rest();
        match usize::try_from(bytes).ok().and_then(|len| rest.split_at_checked(len)) {
            Some((taken, _)) => {
                self.at += taken.len();
                Ok(taken)
            }
            None => {
                let found = format!("the file is cut: {} bytes from byte {} on", rest.len(), self.at);
                Err(self.wrong(found, format!("{bytes} bytes of {what}")))
            }
        }
    }

    fn field<const N: usize>(&mut self, what: &str) -> Result<[u8; N]> {
        let mut field = [0; N];
        field.copy_from_slice(self.take(N as u64, what)?);
        Ok(field)
    }

    pub(in crate::capture) fn u8(&mut self, what: &str) -> Result<u8> {
        self.field::<1>(what).map(|[byte]| byte)
    }

    pub(in crate::capture) fn u16(&mut self, what: &str) -> Result<u16> {
        self.field(what).map(u16::from_le_bytes)
    }

    pub(in crate::capture) fn u32(&mut self, what: &str) -> Result<u32> {
        self.field(what).map(u32::from_le_bytes)
    }

    pub(in crate::capture) fn u64(&mut self, what: &str) -> Result<u64> {
        self.field(what).map(u64::from_le_bytes)
    }

    pub(in crate::capture) fn f32s<const N: usize>(&mut self, what: &str) -> Result<[f32; N]> {
        let mut values = [0.0; N];
        for value in &mut values {
            *value = f32::from_le_bytes(self.field(what)?);
        }
        Ok(values)
    }

    pub(in crate::capture) fn wrong(&self, found: impl std::fmt::Display, expected: impl std::fmt::Display) -> Error {
        Error::input(self.path, found, expected)
    }
}
