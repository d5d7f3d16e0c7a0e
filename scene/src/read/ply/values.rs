//! Values of a PLY file, one after the other.

use super::header::{Encoding, Header, Type};
use crate::read::raw::Result;
use crate::read::text::{number, quoted};

/// Values that are not read yet.
pub(super) struct Values<'a> {
    encoding: Encoding,
    bytes: &'a [u8],
    /// Offset of the next value.
    at: usize,
    /// Line of the next value, from 1, in text.
    line: usize,
}

impl<'a> Values<'a> {
    /// Values after a header.
    pub(super) fn new(header: &Header, bytes: &'a [u8]) -> Self {
        Self { encoding: header.encoding, bytes, at: header.end, line: header.lines + 1 }
    }

    /// Where the next value is, for messages.
    pub(super) fn place(&self) -> String {
        match self.encoding {
            Encoding::Text => format!("line {}", self.line),
            _ => format!("byte {}", self.at),
        }
    }

    /// Next value.
    pub(super) fn value(&mut self, kind: Type) -> Result<f64> {
        let little = match self.encoding {
            Encoding::Text => return self.word(),
            Encoding::LittleEndian => true,
            Encoding::BigEndian => false,
        };
        macro_rules! take {
            ($number:ty) => {{
                let bytes = self.take()?;
                f64::from(if little { <$number>::from_le_bytes(bytes) } else { <$number>::from_be_bytes(bytes) })
            }};
        }
        Ok(match kind {
            Type::I8 => take!(i8),
            Type::U8 => take!(u8),
            Type::I16 => take!(i16),
            Type::U16 => take!(u16),
            Type::I32 => take!(i32),
            Type::U32 => take!(u32),
            Type::F32 => take!(f32),
            Type::F64 => take!(f64),
        })
    }

    /// Length of a list.
    pub(super) fn length(&mut self, kind: Type) -> Result<usize> {
        let length = self.value(kind)?;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "whole, and within 32 bits")]
        if length.fract() == 0.0 && (0.0..4_294_967_296.0).contains(&length) {
            return Ok(length as usize);
        }
        Err(format!("a list of length {length}"))
    }

    /// Goes to the next line of text, and says whether there was more on this one.
    pub(super) fn end_line(&mut self) -> bool {
        if self.encoding != Encoding::Text {
            return false;
        }
        let rest = self.bytes.get(self.at..).unwrap_or(&[]);
        let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len());
        self.at += end;
        !rest[..end].trim_ascii().is_empty()
    }

    fn take<const N: usize>(&mut self) -> Result<[u8; N]> {
        let bytes = self.bytes.get(self.at..).and_then(<[u8]>::first_chunk).ok_or("the file ends")?;
        self.at += N;
        Ok(*bytes)
    }

    fn word(&mut self) -> Result<f64> {
        while let Some(byte) = self.bytes.get(self.at).filter(|byte| byte.is_ascii_whitespace()) {
            // Lines end with \n, \r\n or \r.
            let is_pair = *byte == b'\r' && self.bytes.get(self.at + 1) == Some(&b'\n');
            self.line += usize::from(matches!(byte, b'\n' | b'\r') && !is_pair);
            self.at += 1;
        }
        let rest = &self.bytes[self.at..];
        let end = rest.iter().position(u8::is_ascii_whitespace).unwrap_or(rest.len());
        if end == 0 {
            return Err("the file ends".to_owned());
        }
        let word = &rest[..end];
        let value = number(word).ok_or_else(|| format!("{} is not a number", quoted(word)))?;
        self.at += end;
        Ok(value)
    }
}
