//! Output files that are there whole or not at all.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use crate::error::{Error, Result};

/// Files that are being written and have not got their names yet.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());

fn unfinished() -> MutexGuard<'static, BTreeSet<PathBuf>> {
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Deletes what is being written: for programs that are interrupted and end without unwinding.
pub fn remove_unfinished() {
    for path in unfinished().iter() {
        // The program ends; there is nobody left to tell.
        if path.is_dir() {
            std::fs::remove_dir_all(path).ok();
        } else {
            std::fs::remove_file(path).ok();
        }
    }
}

/// Whether `path` can be written: its folder is there, and it is nothing but perhaps a file.
///
/// # Errors
/// [`Error::Request`] if not.
pub fn check_target(path: &Path) -> Result<()> {
    let folder = folder_of(path);
    if !folder.is_dir() {
        return Err(Error::Request(format!("{}: there is no folder {}", path.display(), folder.display())));
    }
    if path.exists() && !path.is_file() {
        return Err(Error::Request(format!("{}: is there and is not a file", path.display())));
    }
    Ok(())
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// Keeps a file or folder in the list of what goes away when the program is interrupted.
pub struct Unfinished(PathBuf);

impl Unfinished {
    /// Puts it there, until the value is dropped.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        unfinished().insert(path.to_owned());
        Self(path.to_owned())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        unfinished().remove(&self.0);
    }
}

/// Writes `path` through `write`: into a file beside it, which takes its name once everything is on disk.
///
/// # Errors
/// As [`check_target`], and [`Error::Output`] if anything on the way fails; a file that was there before is then still there.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> std::io::Result<()>,
) -> Result<()> {
    check_target(path)?;
    let output = |source| Error::output(path, source);
    let mut file = NamedTempFile::with_prefix_in(".subsurf-", folder_of(path)).map_err(output)?;
    let _listed = Unfinished::new(file.path());
    let mut buffered = BufWriter::new(file.as_file_mut());
    write(&mut buffered).and_then(|()| buffered.flush()).map_err(output)?;
    drop(buffered);
    make_readable(file.as_file()).map_err(output)?;
    file.as_file().sync_data().map_err(output)?;
    file.persist(path).map_err(|failed| output(failed.error))?;
    Ok(())
}

/// [`write_atomically`] of bytes that are there already.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    write_atomically(path, |file| file.write_all(bytes))
}

/// Temporary files are private to their owner; results are not.
#[cfg(unix)]
fn make_readable(file: &File) -> std::io::Result<()> {
    use std::os::unix::fs::PermissionsExt;
    file.set_permissions(std::fs::Permissions::from_mode(0o644))
}

#[cfg(not(unix))]
fn make_readable(_: &File) -> std::io::Result<()> {
    Ok(())
}
