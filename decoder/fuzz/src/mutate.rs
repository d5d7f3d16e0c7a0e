//! Mutation of files: of one section, of the arguments behind the file, or of anything, with checksums made right.
//!
//! Sizes of sections follow from headers, so that a changed header asks for other sections. The reader's own errors say what
//! is missing: a part of the mutants is repaired by them until there is nothing to say.

use crate::parts::{Parts, seal_header, seal_section};
use libfuzzer_sys::fuzzer_mutate;
use subsurf_decoder::container::{Container, Crc};
use subsurf_decoder::{File, ReadError, Section};

/// Bytes that a mutation may add.
const ROOM: usize = 32;
/// Repairs of one mutant.
const MOST_REPAIRS: usize = 64;

/// Random numbers (SplitMix64; Steele, Lea and Flood 2014).
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) % end.max(1) as u64) as usize
    }
}

/// Mutator for libFuzzer: changes the first `size` bytes of `data`, which has room for `max_size`; gives the new size. What is no file becomes
/// one that begins with a section of the kind `header`.
pub fn mutate(data: &mut [u8], size: usize, max_size: usize, seed: u32, header: Section) -> usize {
    let mut random = Random(seed.into());
    if random.below(4) > 0 && in_place(&mut data[..size], &mut random).is_some() {
        return size;
    }
    let parts = Parts::of(&data[..size]);
    if parts.is_some() && random.below(32) == 0 {
        let size = fuzzer_mutate(data, size, max_size);
        seal_header(&mut data[..size]);
        return size;
    }
    let mut parts = parts.unwrap_or_else(|| Parts { sections: vec![(header, Vec::new())], arguments: Vec::new() });
    let count = parts.sections.len();
    match random.below(16) {
        // Arguments are short, and as often changed as they are long.
        0..3 => change(&mut parts.arguments, false),
        3 => {
            let [a, b] = [random.below(count), random.below(count)];
            parts.sections.swap(a, b);
        }
        4 => drop(parts.sections.remove(random.below(count))),
        // Headers stand first.
        5..8 => change(&mut parts.sections[0].1, random.below(4) > 0),
        _ => {
            let at = random.below(count);
            change(&mut parts.sections[at].1, random.below(8) > 0);
        }
    }
    if random.below(4) == 0 {
        repair(&mut parts, max_size);
    }
    let bytes = parts.to_bytes();
    let size = bytes.len().min(max_size);
    data[..size].copy_from_slice(&bytes[..size]);
    size
}

/// Changes bytes of a section, or of the arguments, where they stand, as most mutations do: nothing is copied. `None` for what is no file, and for what has no bytes.
fn in_place(input: &mut [u8], random: &mut Random) -> Option<()> {
    let container = Container::parse(input).ok()?;
    let (count, file_bytes) = (container.entries().count(), container.file().len());
    // Headers stand first, and count for more.
    let number = if random.below(4) == 0 { 0 } else { random.below(count + 1) };
    let (start, end) = match container.entries().nth(number) {
        Some(entry) => (entry.offset as usize, (entry.offset + entry.length) as usize),
        None => (file_bytes, input.len()),
    };
    let bytes = input.get_mut(start..end).filter(|bytes| !bytes.is_empty())?;
    let length = bytes.len();
    let changed = fuzzer_mutate(bytes, length, length);
    bytes[changed..].fill(0);
    if number < count {
        seal_section(input, number, start..end);
        seal_header(input);
    }
    Some(())
}

/// Changes bytes, and their number unless it is to be kept.
fn change(bytes: &mut Vec<u8>, keep_length: bool) {
    let length = bytes.len();
    bytes.resize(length + ROOM, 0);
    let most = if keep_length { length } else { bytes.len() };
    let changed = if most == 0 { 0 } else { fuzzer_mutate(bytes, length, most) };
    bytes.truncate(changed);
    if keep_length {
        bytes.resize(length, 0);
    }
}

/// Does what errors ask for, as long as the file stays within `max_size` and errors are new.
fn repair(parts: &mut Parts, max_size: usize) {
    let mut last = None;
    for _ in 0..MOST_REPAIRS {
        let Err(error) = File::parse_with(&parts.to_bytes(), Crc::Skip) else { return };
        let place = match error {
            ReadError::Missing { section } => {
                parts.section(section);
                (section, 0)
            }
            ReadError::WrongSize { section, need_bytes, .. } if need_bytes <= max_size as u64 => {
                parts.section(section).resize(need_bytes as usize, 0);
                (section, 1)
            }
            ReadError::BadNumber { section, offset, min, max, .. } => {
                let nearest = if max.is_finite() { max } else { min };
                put(parts.at(offset), nearest.to_le_bytes());
                (section, offset)
            }
            ReadError::IndexOutOfRange { section, offset, .. } => {
                put(parts.at(offset), [0; 4]);
                (section, offset)
            }
            _ => return,
        };
        if parts.len() > max_size || last == Some(place) {
            return;
        }
        last = Some(place);
    }
}

/// Replaces the first bytes of a part, as far as it goes.
fn put(part: Option<&mut [u8]>, bytes: [u8; 4]) {
    part.unwrap_or_default().iter_mut().zip(bytes).for_each(|(byte, value)| *byte = value);
}
