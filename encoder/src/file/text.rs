//! Texts that people and other programs wrote.

use std::io::Read as _;
use std::path::Path;

use crate::error::{Error, Result};

/// Text of the file at `path`, of at most `mebibytes`; it is called `expected`.
///
/// # Errors
///
/// [`Error::Input`] for a file that cannot be read or is longer.
pub(crate) fn read_text(path: &Path, mebibytes: u64, expected: &str) -> Result<String> {
    let refuse = |found: String| Error::input(path, found, expected);
    let most = mebibytes << 20;
    let file = std::fs::File::open(path).map_err(|error| refuse(error.to_string()))?;
    let mut bytes = Vec::new();
    // Devices and pipes do not say how long they are.
    file.take(most + 1).read_to_end(&mut bytes).map_err(|error| refuse(error.to_string()))?;
    if bytes.len() as u64 > most {
        return Err(refuse(format!("more than {mebibytes} MiB")));
    }
    // Comments may be in any encoding.
    Ok(String::from_utf8(bytes).unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned()))
}
