//! BTFs of any format, told apart by their names.

use std::path::Path;

use crate::capture::folder::Folder;
use crate::capture::images::Images;
use crate::capture::merl::Merl;
use crate::capture::ubo::Ubo;
use crate::error::Result;
use crate::progress::Progress;

/// Whether a path names a BTF: a folder, a `.btf` file or a `.binary` file. It need not be a good one.
#[must_use]
pub fn is_btf(path: &Path) -> bool {
    path.is_dir() || matches!(extension(path).as_deref(), Some("btf" | "binary"))
}

/// All images of a BTF: of a `.btf` file of UBO2014, of an isotropic BRDF of MERL (`.binary`), or of a folder.
///
/// # Errors
/// As [`Ubo::open`], [`Merl::open`], [`Folder::open`] and [`Images::load`].
pub fn load_btf(path: &Path, progress: &dyn Progress) -> Result<Images> {
    match extension(path).as_deref() {
        Some("btf") => Images::load(&Ubo::open(path)?, progress),
        Some("binary") => Images::load(&Merl::open(path)?, progress),
        _ => Images::load(&Folder::open(path)?, progress),
    }
}

fn extension(path: &Path) -> Option<String> {
    Some(path.extension()?.to_str()?.to_ascii_lowercase())
}
