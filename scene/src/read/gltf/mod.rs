//! Meshes from glTF 2.0: all triangles of the default scene, in the places and the pose that its nodes put them.

mod accessor;
mod buffers;
mod container;
mod document;
mod draco;
mod extensions;
mod instances;
mod meshopt;
mod nodes;
mod primitive;
mod skin;

use std::path::Path;

use serde::Deserialize;
use serde_json::Value;

use self::accessor::Accessors;
use self::buffers::Buffers;
use self::container::Parts;
use self::document::{Document, Versioned};
use self::nodes::place;
use self::primitive::Builder;
use super::raw::{Raw, Result};
use super::text::{quoted, shortened};

/// Reads the bytes of a .gltf or .glb file that is in `folder`, where the files are that it names.
pub(super) fn read(bytes: &[u8], folder: &Path) -> Result<Raw> {
    let Parts { json, chunk } = container::split(bytes)?;
    // Names may be in any encoding.
    let json = String::from_utf8_lossy(&json);
    match &parse::<Versioned>(&json)?.asset.version {
        // Some leave it out.
        Value::Null => {}
        Value::String(version) if version.starts_with("2.") || version.is_empty() => {}
        version => return Err(format!("glTF version {}; expected 2.0", quoted(version.to_string().as_bytes()))),
    }
    let document: Document = parse(&json)?;
    let buffers = Buffers::new(&document, folder, chunk);
    let accessors = Accessors { document: &document, buffers: &buffers };
    let mut builder = Builder::new(accessors);
    extensions::warn(&document, &mut builder.out);
    place(&document, accessors, &mut builder)?;
    Ok(builder.finish())
}

fn parse<'a, T: Deserialize<'a>>(json: &'a str) -> Result<T> {
    serde_json::from_str(json).map_err(|error| {
        // A message may quote a value of any length.
        let message = error.to_string();
        let what = message.split(" at line ").next().unwrap_or(&message);
        format!("JSON, line {}, column {}: {}", error.line(), error.column(), shortened(what, 160))
    })
}
