//! Header of a PLY file: its elements and their properties.

use crate::read::raw::Result;
use crate::read::text::{Lines, quoted};

/// Encoding of the values after the header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Encoding {
    Text,
    LittleEndian,
    BigEndian,
}

/// Type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn parse(word: &[u8]) -> Result<Self> {
        Ok(match word {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => {
                return Err(format!(
                    "a property of type {}; expected char, uchar, short, ushort, int, uint, float or double",
                    quoted(word)
                ));
            }
        })
    }
}

/// Property of an element: a number, or a list of them whose length is stored as the first type.
#[derive(Debug)]
pub(super) struct Property {
    pub(super) name: String,
    pub(super) length: Option<Type>,
    pub(super) value: Type,
}

/// Elements of one kind, such as vertices.
#[derive(Debug)]
pub(super) struct Element {
    pub(super) name: String,
    pub(super) count: u64,
    pub(super) properties: Vec<Property>,
}

#[derive(Debug)]
pub(super) struct Header {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element>,
    /// Lines of the header.
    pub(super) lines: usize,
    /// Where the values begin, in bytes.
    pub(super) end: usize,
}

impl Header {
    pub(super) fn parse(bytes: &[u8]) -> Result<Self> {
        let mut lines = Lines::new(bytes);
        if lines.next().is_none_or(|(_, line)| line.trim_ascii() != b"ply") {
            return Err("does not begin with the line \"ply\"".to_owned());
        }
        let mut encoding = None;
        let mut elements: Vec<Element> = Vec::new();
        for (number, line) in lines {
            let words: Vec<&[u8]> = line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
            let at_line = |error: String| format!("line {number}: {error}");
            match words[..] {
                [b"end_header", ..] => {
                    let encoding = encoding.ok_or("a header without format")?;
                    return Ok(Self { encoding, elements, lines: number, end: end_of_line(line, bytes) });
                }
                [b"format", name, ..] => encoding = Some(parse_encoding(name).map_err(at_line)?),
                [b"element", name, count, ..] => {
                    let number = std::str::from_utf8(count).ok().and_then(|count| count.parse().ok());
                    let count =
                        number.ok_or_else(|| at_line(format!("{} is not a number of elements", quoted(count))))?;
                    elements.push(Element { name: text(name), count, properties: Vec::new() });
                }
                [b"property", ref rest @ ..] => {
                    let property = parse_property(rest).map_err(at_line)?;
                    let element =
                        elements.last_mut().ok_or_else(|| at_line("a property before any element".to_owned()))?;
                    element.properties.push(property);
                }
                // Comments, and whatever else there may be.
                _ => {}
            }
        }
        Err("a header without end_header".to_owned())
    }
}

fn parse_encoding(name: &[u8]) -> Result<Encoding> {
    match name {
        b"ascii" => Ok(Encoding::Text),
        b"binary_little_endian" => Ok(Encoding::LittleEndian),
        b"binary_big_endian" => Ok(Encoding::BigEndian),
        _ => Err(format!("format {}; expected ascii, binary_little_endian or binary_big_endian", quoted(name))),
    }
}

fn parse_property(words: &[&[u8]]) -> Result<Property> {
    match *words {
        [b"list", length, value, name, ..] => {
            Ok(Property { name: text(name), length: Some(Type::parse(length)?), value: Type::parse(value)? })
        }
        [value, name, ..] => Ok(Property { name: text(name), length: None, value: Type::parse(value)? }),
        _ => Err("expected property TYPE NAME, or property list TYPE TYPE NAME".to_owned()),
    }
}

fn text(word: &[u8]) -> String {
    String::from_utf8_lossy(word).into_owned()
}

/// Where the line after `line`, a part of `bytes`, begins.
fn end_of_line(line: &[u8], bytes: &[u8]) -> usize {
    let end = line.as_ptr_range().end.addr() - bytes.as_ptr().addr();
    match bytes[end..] {
        [b'\r', b'\n', ..] => end + 2,
        [_, ..] => end + 1,
        [] => end,
    }
}
