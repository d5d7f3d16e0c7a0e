//! Bytes of a glTF file: buffers beside it or within it, and views of them. What no mesh needs is not looked for.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::path::Path;

use base64::engine::general_purpose::{GeneralPurpose, GeneralPurposeConfig};
use base64::engine::{DecodePaddingMode, Engine};
use serde::Deserialize;

use super::document::{Compressed, Document, Whole, named};
use super::meshopt;
use crate::read::raw::Result;
use crate::read::text::quoted;

/// Base64, padded or not.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &base64::alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);
/// Names of the extension of compressed views.
const MESHOPT: [&str; 2] = ["EXT_meshopt_compression", "KHR_meshopt_compression"];

/// Bytes of a view, and how far its elements are from each other if it says so.
#[derive(Clone, Copy, Debug)]
pub(super) struct View<'a> {
    pub(super) bytes: &'a [u8],
    pub(super) stride: Option<usize>,
}

/// Buffers of a document.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    folder: &'a Path,
    /// Binary chunk of a .glb file.
    chunk: Option<&'a [u8]>,
    buffers: Vec<OnceCell<Vec<u8>>>,
    /// Views that were compressed.
    views: Vec<OnceCell<Vec<u8>>>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(document: &'a Document, folder: &'a Path, chunk: Option<&'a [u8]>) -> Self {
        let buffers = document.buffers.iter().map(|_| OnceCell::new()).collect();
        let views = document.buffer_views.iter().map(|_| OnceCell::new()).collect();
        Self { document, folder, chunk, buffers, views }
    }

    /// View of a number.
    pub(super) fn view(&self, number: Whole) -> Result<View<'_>> {
        let view = named(&self.document.buffer_views, "bufferView", number)?;
        let number = number.0;
        let at = |error: String| format!("bufferView {number}: {error}");
        let bytes = match MESHOPT.iter().find_map(|name| view.extensions.get(*name)) {
            None => self.bytes(view.buffer, view.byte_offset, view.byte_length),
            Some(compressed) => cached(&self.views[number], || {
                let compressed = Compressed::deserialize(compressed).map_err(|error| error.to_string())?;
                let bytes = self.bytes(compressed.buffer, compressed.byte_offset, compressed.byte_length)?;
                meshopt::expand(bytes, &compressed)
            }),
        };
        Ok(View { bytes: bytes.map_err(at)?, stride: view.byte_stride.map(|stride| stride.0) })
    }

    /// Part of a buffer.
    fn bytes(&self, number: Whole, offset: Whole, length: Whole) -> Result<&[u8]> {
        let buffer = self.buffer(number)?;
        let (Whole(number), Whole(offset), Whole(length)) = (number, offset, length);
        let part = buffer.get(offset..).and_then(|rest| rest.get(..length));
        part.ok_or_else(|| {
            format!("{length} bytes from byte {offset} on of buffer {number}, which has {}", buffer.len())
        })
    }

    fn buffer(&self, number: Whole) -> Result<&[u8]> {
        let buffer = named(&self.document.buffers, "buffer", number)?;
        let number = number.0;
        let Some(uri) = &buffer.uri else {
            // Only the first is the binary chunk.
            let chunk = self.chunk.filter(|_| number == 0);
            return chunk.ok_or_else(|| format!("buffer {number} has no uri, and is no binary chunk of a .glb file"));
        };
        cached(&self.buffers[number], || self.load(uri).map_err(|error| format!("buffer {number}: {error}")))
    }

    /// Bytes that a URI has, or the file that it names.
    fn load(&self, uri: &str) -> Result<Vec<u8>> {
        if let Some(data) = uri.strip_prefix("data:") {
            let (kind, data) = data.split_once(',').ok_or("a data URI without a comma")?;
            if !kind.ends_with(";base64") {
                return Ok(percent_encoding::percent_decode_str(data).collect());
            }
            return BASE64.decode(data.trim_ascii()).map_err(|error| format!("a data URI: {error}"));
        }
        if uri.contains("://") {
            return Err(format!("is at {}; expected a file beside the .gltf", quoted(uri.as_bytes())));
        }
        let name: Cow<'_, str> = percent_encoding::percent_decode_str(uri).decode_utf8_lossy();
        std::fs::read(self.folder.join(&*name))
            .map_err(|error| format!("the file {}: {error}", quoted(name.as_bytes())))
    }
}

/// Bytes that are made when they are first asked for.
fn cached(cell: &OnceCell<Vec<u8>>, make: impl FnOnce() -> Result<Vec<u8>>) -> Result<&[u8]> {
    if let Some(bytes) = cell.get() {
        return Ok(bytes);
    }
    let bytes = make()?;
    Ok(cell.get_or_init(|| bytes))
}
