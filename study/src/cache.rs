//! Cache: results in the study's folder, so that a study that was interrupted goes on where it was.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use subsurf_encoder::write_bytes;

/// Result in a file, if there is one that can be read.
pub(crate) fn read<T: DeserializeOwned>(path: &Path) -> Option<T> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

/// Writes a result, whole or not at all.
pub(crate) fn write(path: &Path, result: &impl Serialize) -> anyhow::Result<()> {
    Ok(write_bytes(path, format!("{:#}\n", serde_json::to_value(result)?).as_bytes())?)
}
