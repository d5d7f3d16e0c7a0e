//! Output files that are there whole or not at all.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{BufWriter, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::{Builder, NamedTempFile};

use crate::error::{Error, Result};
use crate::memory::gigabytes;

/// Files that are being written and have not got their names yet.
static UNFINISHED: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
/// Symbolic links behind each other that are followed.
const MAX_LINKS: usize = 40;
/// What names of unfinished files begin with.
pub(crate) const PREFIX: &str = ".subsurf-";

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

/// Whether `path` can be written: its folder is there and lets files be made in it, and it is nothing but perhaps a file
/// that is not write-protected. Symbolic links are followed, as by any program that opens a file to write to it.
///
/// # Errors
/// [`Error::Request`] if not.
pub fn check_target(path: &Path) -> Result<()> {
    checked_target(path).map(drop)
}

/// The file that `path` stands for, if it can be written.
fn checked_target(path: &Path) -> Result<PathBuf> {
    let target = behind_links(path)?;
    check_folder(path, folder_of(&target))?;
    let refuse = |what: &str| Err(Error::Request(format!("{}: {what}", path.display())));
    match std::fs::metadata(&target) {
        Ok(found) if !found.is_file() => refuse("is there and is not a file"),
        Ok(found) if found.permissions().readonly() => refuse("is there and is write-protected"),
        _ => Ok(target),
    }
}

/// Whether `path` can be made as a new folder.
///
/// # Errors
/// [`Error::Request`] if not.
pub(crate) fn check_new_folder(path: &Path) -> Result<()> {
    if path.symlink_metadata().is_ok() {
        let path = path.display();
        return Err(Error::Request(format!("{path}: is there already; remove it, or name another folder")));
    }
    check_folder(path, folder_of(path))
}

/// Whether files can be made in the folder of `path`.
fn check_folder(path: &Path, folder: &Path) -> Result<()> {
    if !folder.is_dir() {
        return Err(Error::Request(format!("{}: there is no folder {}", path.display(), folder.display())));
    }
    match tempfile::tempfile_in(folder) {
        Err(error) if matches!(error.kind(), ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem) => {
            let (path, folder) = (path.display(), folder.display());
            Err(Error::Request(format!("{path}: nothing can be written to the folder {folder} ({})", error.kind())))
        }
        // Whatever else may be wrong, writing will tell.
        _ => Ok(()),
    }
}

pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// The file that `path` stands for, which need not be there yet.
fn behind_links(path: &Path) -> Result<PathBuf> {
    let mut target = path.to_owned();
    for _ in 0..MAX_LINKS {
        match std::fs::read_link(&target) {
            Ok(to) => target = folder_of(&target).join(to),
            Err(_) => return Ok(target),
        }
    }
    Err(Error::Request(format!("{}: too many symbolic links behind each other", path.display())))
}

/// Refuses to write more beside `path` than there is room for; `what` names it.
///
/// # Errors
/// [`Error::Request`] with both numbers.
pub(crate) fn expect_space(path: &Path, need_bytes: u64, what: impl FnOnce() -> String) -> Result<()> {
    match free_bytes(path) {
        Some(free) if need_bytes > free => {
            let [need, free] = [need_bytes, free].map(gigabytes);
            Err(Error::Request(format!("{} takes up to {need} of disk while it is made, and there is {free}", what())))
        }
        _ => Ok(()),
    }
}

/// Bytes that can still be written beside `path`, as far as the system tells.
#[cfg(unix)]
fn free_bytes(path: &Path) -> Option<u64> {
    let disk = rustix::fs::statvfs(folder_of(path)).ok()?;
    disk.f_bavail.checked_mul(disk.f_frsize)
}

#[cfg(not(unix))]
fn free_bytes(_: &Path) -> Option<u64> {
    None
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

/// Writes `path` through `write`: into a file beside it, which takes its name once everything is on disk. Where `path` is
/// a symbolic link, what it leads to is written; a file that was there keeps its permissions.
///
/// # Errors
/// As [`check_target`], and [`Error::Output`] if anything on the way fails; a file that was there before is then still there.
pub fn write_atomically(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&mut File>) -> std::io::Result<()>,
) -> Result<()> {
    let target = checked_target(path)?;
    let output = |source| Error::output(path, source);
    let mut file = new_file(folder_of(&target)).map_err(output)?;
    let _listed = Unfinished::new(file.path());
    let mut buffered = BufWriter::new(file.as_file_mut());
    write(&mut buffered).and_then(|()| buffered.flush()).map_err(output)?;
    drop(buffered);
    if let Ok(found) = std::fs::metadata(&target) {
        file.as_file().set_permissions(found.permissions()).map_err(output)?;
    }
    file.as_file().sync_data().map_err(output)?;
    file.persist(&target).map_err(|failed| output(failed.error))?;
    Ok(())
}

/// [`write_atomically`] of bytes that are there already.
///
/// # Errors
/// As [`write_atomically`].
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    write_atomically(path, |file| file.write_all(bytes))
}

/// A file with a name of its own. Temporary files are private to their owner; results are what the user's mask says.
fn new_file(folder: &Path) -> std::io::Result<NamedTempFile> {
    let mut builder = Builder::new();
    builder.prefix(PREFIX);
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    builder.tempfile_in(folder)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn room_that_is_not_there_is_foreseen() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("file");
        if free_bytes(&path).is_none() {
            return;
        }
        assert!(expect_space(&path, 1, || "little".to_owned()).is_ok(), "there is room for a byte");
        let error = expect_space(&path, u64::MAX, || "all of it".to_owned()).unwrap_err().to_string();
        assert!(error.starts_with("all of it takes up to 18446744073.710 GB of disk while it is made, and"), "{error}");
    }
}
