//! Views compressed by EXT_meshopt_compression, or KHR_meshopt_compression: attributes, triangles or indices.
//! The names of the values are those of the appendices of its specification.

mod attributes;
mod filters;
mod indices;

use super::document::Compressed;
use crate::read::raw::{Result, count};
use crate::read::text::quoted;

/// Bytes that a compressed view stands for.
pub(super) fn expand(bytes: &[u8], view: &Compressed) -> Result<Vec<u8>> {
    let (elements, stride) = (view.count.0, view.byte_stride.0);
    count(elements)?;
    let filter = view.filter.as_deref().unwrap_or("NONE");
    let wrong = || {
        let [mode, filter] = [&view.mode, filter].map(|name| quoted(name.as_bytes()));
        format!(
            "meshopt: mode {mode}, filter {filter}, {elements} elements of {stride} bytes, which do not fit together"
        )
    };
    let is_index = |filter: &str| matches!(stride, 2 | 4) && filter == "NONE";
    let mut bytes = Reader { bytes };
    let expanded = match view.mode.as_str() {
        "ATTRIBUTES" if stride % 4 == 0 && (4..=256).contains(&stride) => {
            let mut out = attributes::decode(&mut bytes, elements, stride)?;
            match (filter, stride) {
                ("NONE", _) => {}
                ("OCTAHEDRAL", 4) => out.as_chunks_mut().0.iter_mut().for_each(filters::octahedral_8),
                ("OCTAHEDRAL", 8) => out.as_chunks_mut().0.iter_mut().for_each(filters::octahedral_16),
                ("QUATERNION", 8) => out.as_chunks_mut().0.iter_mut().for_each(filters::quaternion),
                ("EXPONENTIAL", _) => out.as_chunks_mut().0.iter_mut().for_each(filters::exponential),
                _ => return Err(wrong()),
            }
            return Ok(out);
        }
        "TRIANGLES" if is_index(filter) && elements % 3 == 0 => indices::triangles(&mut bytes, elements)?,
        "INDICES" if is_index(filter) => indices::sequence(&mut bytes, elements)?,
        _ => return Err(wrong()),
    };
    Ok(expanded.iter().flat_map(|index| index.to_le_bytes().into_iter().take(stride)).collect())
}

/// Bytes that are not read yet.
struct Reader<'a> {
    bytes: &'a [u8],
}

impl<'a> Reader<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8]> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or("meshopt: the compressed bytes end too early")?;
        self.bytes = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8> {
        self.take(1).map(|byte| byte[0])
    }

    /// The last bytes, which come after all else.
    fn tail(&mut self, count: usize) -> Result<&'a [u8]> {
        let at = self.bytes.len().checked_sub(count).ok_or("meshopt: the compressed bytes are too few")?;
        let (rest, tail) = self.bytes.split_at(at);
        self.bytes = rest;
        Ok(tail)
    }

    /// A number in groups of seven bits, the lowest first.
    fn varint(&mut self) -> Result<u32> {
        let mut value = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return Ok(value);
            }
        }
        Err("meshopt: a number of more than five bytes".to_owned())
    }

    fn end(&self) -> Result<()> {
        if self.bytes.is_empty() { Ok(()) } else { Err(format!("meshopt: {} bytes too many", self.bytes.len())) }
    }
}

/// Difference whose sign is in its lowest bit.
fn unzigzag(value: u32) -> u32 {
    if value & 1 == 0 { value >> 1 } else { !(value >> 1) }
}
