//! Metadata of files that are written: `--meta KEY=VALUE`.

use subsurf_encoder::rate::Target;
use subsurf_encoder::{Error, metadata_bytes, with_metadata};

use crate::program::failure::bad_request;

/// What the file says of itself.
#[derive(clap::Args)]
pub(crate) struct MetaArgs {
    /// Write into the file who made what: name, author, licence, source, tool, or any other key. Once for each; an empty value takes a key out. `subsurf info` shows them
    #[arg(long, value_name = "KEY=VALUE", value_parser = entry)]
    meta: Vec<(String, String)>,
}

fn entry(text: &str) -> Result<(String, String), String> {
    let (key, value) = text.split_once('=').ok_or("expected KEY=VALUE, for example author=Ada")?;
    if key.trim().is_empty() {
        return Err("no key before `=`; for example author=Ada".to_owned());
    }
    Ok((key.trim().to_owned(), value.trim().to_owned()))
}

impl MetaArgs {
    /// The same file with the metadata.
    pub(crate) fn added_to(&self, file: Vec<u8>) -> anyhow::Result<Vec<u8>> {
        Ok(if self.meta.is_empty() { file } else { with_metadata(&file, &self.meta)? })
    }

    /// An error of a search for a file of a size that left room for metadata, which says so.
    pub(crate) fn explain(&self, error: Error, has_limit: bool) -> anyhow::Error {
        match metadata_bytes(&self.meta) {
            Ok(kept) if kept > 0 && has_limit && error.is_callers() => {
                bad_request(format!("{error}; {kept} bytes of the limit are kept for the metadata of --meta"))
            }
            _ => error.into(),
        }
    }

    /// What a target in bytes leaves beside the metadata.
    pub(crate) fn leave_room(&self, target: Target) -> anyhow::Result<Target> {
        let kept = metadata_bytes(&self.meta)?;
        let Target::Bytes(limit) = target else { return Ok(target) };
        let rest = limit.checked_sub(kept).filter(|rest| *rest > 0);
        rest.map(Target::Bytes)
            .ok_or_else(|| bad_request(format!("{limit} bytes: the metadata of --meta alone takes up to {kept}")))
    }
}
