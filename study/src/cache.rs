//! Results in the study's folder: a study that was interrupted goes on where it was.

use std::path::Path;

use serde::Serialize;
use serde::de::DeserializeOwned;
use subsurf_encoder::write_bytes;

/// What was kept in a file, if that can be read.
pub(super) fn read<T: DeserializeOwned>(path: &Path) -> Option<T> {
    serde_json::from_slice(&std::fs::read(path).ok()?).ok()
}

pub(super) fn write(path: &Path, result: &impl Serialize) -> anyhow::Result<()> {
    Ok(write_bytes(path, format!("{:#}\n", serde_json::to_value(result)?).as_bytes())?)
}
