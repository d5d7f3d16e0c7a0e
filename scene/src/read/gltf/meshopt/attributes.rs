//! Mode 0: attributes, as differences to the element before, each byte of an element apart.

use super::{Reader, unzigzag};
use crate::read::raw::Result;

/// Elements that share a number of bits.
const GROUP: usize = 16;
/// Bits of a group's differences by the two bits of its header, in version 0, and in modes 0 and 1 of version 1.
const BITS: [[u8; 4]; 3] = [[0, 2, 4, 8], [0, 1, 2, 4], [1, 2, 4, 8]];

/// Bytes of `count` elements of `stride` bytes.
pub(super) fn decode(bytes: &mut Reader<'_>, count: usize, stride: usize) -> Result<Vec<u8>> {
    let has_modes = match bytes.byte()? {
        0xa0 => false,
        0xa1 => true,
        header => return Err(format!("meshopt: attributes of header {header:#04x}; expected 0xa0 or 0xa1")),
    };
    // The tail: padding, the element before the first, and in version 1 the mode of each four bytes.
    let modes = if has_modes { stride / 4 } else { 0 };
    let smallest = if has_modes { 24 } else { 32 };
    let tail = bytes.tail(smallest.max(stride + modes))?;
    let (tail, modes) = tail.split_at(tail.len() - modes);
    let mut last = tail[tail.len() - stride..].to_vec();

    let mut out = Vec::new();
    let longest = (8192 / stride / GROUP * GROUP).min(256);
    while out.len() < count * stride {
        let elements = longest.min(count - out.len() / stride);
        let controls = if has_modes { bytes.take(stride / 4)? } else { &[] };
        let columns = (0..stride)
            .map(|k| match controls.get(k / 4).map(|control| control >> (2 * (k % 4)) & 3) {
                None => groups(bytes, elements, BITS[0]),
                Some(mode @ (0 | 1)) => groups(bytes, elements, BITS[usize::from(mode) + 1]),
                Some(2) => Ok(vec![0; elements]),
                Some(_) => bytes.take(elements).map(<[u8]>::to_vec),
            })
            .collect::<Result<Vec<_>>>()?;
        for element in 0..elements {
            for (channel, values) in last.as_chunks_mut::<4>().0.iter_mut().enumerate() {
                let difference = [0, 1, 2, 3].map(|k| columns[4 * channel + k][element]);
                *values = add(*values, difference, modes.get(channel).copied().unwrap_or(0))?;
            }
            out.extend_from_slice(&last);
        }
    }
    bytes.end()?;
    Ok(out)
}

/// Differences of one byte of all elements of a block.
fn groups(bytes: &mut Reader<'_>, elements: usize, bits: [u8; 4]) -> Result<Vec<u8>> {
    let count = elements.div_ceil(GROUP);
    let headers = bytes.take(count.div_ceil(4))?;
    let mut out = Vec::with_capacity(count * GROUP);
    for group in 0..count {
        match bits[usize::from(headers[group / 4] >> (2 * (group % 4)) & 3)] {
            0 => out.resize(out.len() + GROUP, 0),
            8 => out.extend_from_slice(bytes.take(GROUP)?),
            bits => {
                // All ones stand for a byte that follows.
                let escape = (1 << bits) - 1;
                let per_byte = 8 / bits;
                for &packed in bytes.take(GROUP / usize::from(per_byte))? {
                    for k in 0..per_byte {
                        // Single bits come from the lowest on, pairs and fours from the highest.
                        let shift = if bits == 1 { k } else { 8 - bits * (k + 1) };
                        out.push(packed >> shift & escape);
                    }
                }
                let first = out.len() - GROUP;
                for value in &mut out[first..] {
                    if *value == escape {
                        *value = bytes.byte()?;
                    }
                }
            }
        }
    }
    Ok(out)
}

/// Four bytes of an element from those of the one before.
#[allow(clippy::cast_possible_truncation, reason = "differences wrap around")]
fn add(values: [u8; 4], difference: [u8; 4], mode: u8) -> Result<[u8; 4]> {
    match (mode & 15, mode >> 4) {
        // Single bytes.
        (0, 0) => Ok([0, 1, 2, 3].map(|k| {
            let zigzag = difference[k];
            values[k].wrapping_add(if zigzag & 1 == 0 { zigzag >> 1 } else { !(zigzag >> 1) })
        })),
        // Pairs of bytes.
        (1, 0) => {
            let [low, high] = [0, 2].map(|k| {
                let [value, zigzag] = [values, difference].map(|bytes| u16::from_le_bytes([bytes[k], bytes[k + 1]]));
                value.wrapping_add(unzigzag(zigzag.into()) as u16).to_le_bytes()
            });
            Ok([low[0], low[1], high[0], high[1]])
        }
        // All four, exclusive or.
        (2, turn) => {
            let difference = u32::from_le_bytes(difference).rotate_right(turn.into());
            Ok((u32::from_le_bytes(values) ^ difference).to_le_bytes())
        }
        _ => Err(format!("meshopt: channel mode {mode:#04x}; expected 0, 1 or 2")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of the specification.
    #[test]
    fn groups_of_four_bits_have_escapes() {
        let bytes = [0x02, 0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let mut reader = Reader { bytes: &bytes };
        let out = groups(&mut reader, 16, BITS[0]).unwrap();
        reader.end().unwrap();
        let values: Vec<i32> =
            out.iter().map(|byte| i32::from(add([0; 4], [*byte; 4], 0).unwrap()[0].cast_signed())).collect();
        assert_eq!(values, [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]);
    }

    #[test]
    fn differences_of_all_modes() {
        assert_eq!(add([0, 5, 0, 0], [1, 2, 0, 0], 0), Ok([255, 6, 0, 0]));
        assert_eq!(add([0, 0, 255, 0], [1, 0, 2, 0], 1), Ok([255, 255, 0, 1]));
        assert_eq!(add([1, 0, 0, 0], [0x10, 0, 0, 0], 0x42), Ok([0, 0, 0, 0]));
        assert!(add([0; 4], [0; 4], 3).is_err() && add([0; 4], [0; 4], 0x10).is_err(), "unknown modes");
    }
}
