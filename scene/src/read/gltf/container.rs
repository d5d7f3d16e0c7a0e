//! Container of .glb files: the JSON and the bytes that it names.

use std::borrow::Cow;

use crate::read::raw::Result;
use crate::read::text::{quoted, without_mark};

/// Parts of a file.
pub(super) struct Parts<'a> {
    pub(super) json: Cow<'a, [u8]>,
    /// Binary chunk of a .glb file, if it has one.
    pub(super) chunk: Option<&'a [u8]>,
}

/// Parts of a .gltf or .glb file, by what it begins with.
pub(super) fn split(bytes: &[u8]) -> Result<Parts<'_>> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        let json = without_mark(bytes);
        if !json.trim_ascii_start().starts_with(b"{") {
            let begins = quoted(&bytes[..bytes.len().min(8)]);
            return Err(format!("begins with {begins}; expected JSON, or glTF in binary"));
        }
        return Ok(Parts { json, chunk: None });
    };
    let Some((header, mut chunks)) = rest.split_first_chunk::<8>() else {
        return Err(format!("{} bytes; a .glb file has a header of 12", bytes.len()));
    };
    let version = u32::from_le_bytes([0, 1, 2, 3].map(|k| header[k]));
    if version != 2 {
        return Err(format!("binary glTF version {version}; expected 2"));
    }
    let mut json = None;
    while let Some((header, rest)) = chunks.split_first_chunk::<8>() {
        let length = u32::from_le_bytes([0, 1, 2, 3].map(|k| header[k])) as usize;
        let offset = bytes.len() - rest.len();
        let (chunk, rest) = rest.split_at_checked(length).ok_or_else(|| {
            format!("a chunk of {length} bytes from byte {offset} on; the file ends {} bytes after it", rest.len())
        })?;
        match (&header[4..], json) {
            (b"JSON", None) => json = Some(chunk),
            (b"BIN\0", Some(json)) => return Ok(Parts { json: without_mark(json), chunk: Some(chunk) }),
            _ => {}
        }
        // Chunks begin at multiples of four bytes.
        chunks = rest;
    }
    let json = json.ok_or("a .glb file without a JSON chunk")?;
    Ok(Parts { json: without_mark(json), chunk: None })
}
