//! Arrays in archives of NumPy, `.npz`: a ZIP file of `.npy` files, stored or deflated.

use std::io::{Cursor, Read};
use std::ops::Range;
use std::path::Path;

use zip::{CompressionMethod, ZipArchive};

use super::array::{EXPECTED, Header};
use super::header_text::MAX_HEADER;
use crate::error::{Error, Result};
use crate::memory;

/// First bytes of any ZIP file that has entries.
pub(super) const MAGIC: &[u8] = b"PK\x03\x04";
/// Deflate makes no file smaller than this share of it.
const LARGEST_RATIO: u64 = 1_032;

/// An array of an archive.
pub(super) enum Entry {
    /// Stored as it is, in these bytes of the file.
    Stored(Range<usize>),
    /// Inflated into memory.
    Inflated(Vec<u8>),
}

type Archive<'a> = ZipArchive<Cursor<&'a [u8]>>;

/// The one array of an archive that can be a capture, and names of the others.
pub(super) fn open(path: &Path, file: &[u8]) -> Result<(Entry, Vec<String>)> {
    let wrong = |found: String| Error::input(path, found, EXPECTED);
    let broken = |error| wrong(format!("a broken .npz file ({error})"));
    let mut archive = ZipArchive::new(Cursor::new(file)).map_err(broken)?;
    let mut names = Vec::new();
    for number in 0..archive.len() {
        let name = archive.by_index_raw(number).map_err(broken)?.name().to_owned();
        if let Some(name) = name.strip_suffix(".npy") {
            names.push((number, name.to_owned()));
        }
    }
    let chosen = match &names[..] {
        [] => return Err(wrong("a .npz file without an array".to_owned())),
        [(number, _)] => *number,
        several => {
            let mut fitting = several.iter().filter(|(number, _)| is_capture(&mut archive, *number));
            match (fitting.next(), fitting.next()) {
                (Some((number, _)), None) => *number,
                (first, _) => {
                    let all: Vec<&str> = several.iter().map(|(_, name)| name.as_str()).collect();
                    let how_many = if first.is_some() { "several" } else { "none" };
                    return Err(wrong(format!("arrays {}, {how_many} of them a capture", all.join(", "))));
                }
            }
        }
    };
    let others = names.into_iter().filter(|(number, _)| *number != chosen).map(|(_, name)| name).collect();
    let entry = entry(path, &mut archive, chosen).map_err(wrong)?;
    if let Entry::Stored(range) = &entry
        && range.end > file.len()
    {
        return Err(wrong("a .npz file that is cut".to_owned()));
    }
    Ok((entry, others))
}

/// Whether an array has the shape of a capture.
fn is_capture(archive: &mut Archive<'_>, number: usize) -> bool {
    let mut head = Vec::new();
    let read = archive.by_index(number).is_ok_and(|file| file.take(MAX_HEADER as u64).read_to_end(&mut head).is_ok());
    read && Header::parse(&head).is_ok_and(|header| matches!(header.shape[..], [_, _, _, _, 3]))
}

fn entry(path: &Path, archive: &mut Archive<'_>, number: usize) -> std::result::Result<Entry, String> {
    let broken = |error: &dyn std::fmt::Display| format!("a broken .npz file ({error})");
    let mut file = archive.by_index(number).map_err(|error| broken(&error))?;
    let (bytes, compressed) = (file.size(), file.compressed_size());
    if file.compression() == CompressionMethod::Stored {
        let start = file.data_start().ok_or("a .npz file that is cut")?;
        let [start, length] = [start, compressed].map(|bytes| usize::try_from(bytes).unwrap_or(usize::MAX));
        return Ok(Entry::Stored(start..start.saturating_add(length)));
    }
    if bytes / LARGEST_RATIO > compressed {
        return Err(format!("a .npz file whose {compressed} bytes are to be {bytes}"));
    }
    memory::expect(bytes, || format!("{}: the array", path.display())).map_err(|error| error.to_string())?;
    let mut values = Vec::new();
    let length = usize::try_from(bytes).map_err(|error| broken(&error))?;
    values.try_reserve_exact(length).map_err(|error| broken(&error))?;
    file.by_ref().take(bytes).read_to_end(&mut values).map_err(|error| broken(&error))?;
    Ok(Entry::Inflated(values))
}
