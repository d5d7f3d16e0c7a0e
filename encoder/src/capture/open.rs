//! BTFs of any format, told apart by their names.

use std::path::Path;

use crate::capture::folder::Folder;
use crate::capture::images::Images;
use crate::capture::merl::Merl;
use crate::capture::rgl::Rgl;
use crate::capture::source::Source;
use crate::capture::ubo::Ubo;
use crate::error::Result;
use crate::progress::Progress;

/// Whether a path names a BTF or a BRDF: a folder, or a `.btf`, `.binary` or `.bsdf` file. It need not be a good one.
#[must_use]
pub fn is_btf(path: &Path) -> bool {
    path.is_dir() || matches!(extension(path).as_deref(), Some("btf" | "binary" | "bsdf"))
}

/// A BTF by its name: a `.btf` file of UBO2014, an isotropic BRDF of MERL (`.binary`) or of RGL (`.bsdf`), or a folder.
///
/// # Errors
/// As [`Ubo::open`], [`Merl::open`], [`Rgl::open`] and [`Folder::open`].
pub fn open_btf(path: &Path) -> Result<Box<dyn Source>> {
    Ok(match extension(path).as_deref() {
        _ if path.is_dir() => Box::new(Folder::open(path)?),
        Some("btf") => Box::new(Ubo::open(path)?),
        Some("binary") => Box::new(Merl::open(path)?),
        Some("bsdf") => Box::new(Rgl::open(path)?),
        _ => Box::new(Folder::open(path)?),
    })
}

/// All images of a BTF.
///
/// # Errors
/// As [`open_btf`] and [`Images::load`].
pub fn load_btf(path: &Path, progress: &dyn Progress) -> Result<Images> {
    Images::load(open_btf(path)?.as_ref(), progress)
}

fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}
