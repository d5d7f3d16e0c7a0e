//! Writes captures window by window.

use std::io::{self, Write};
use std::path::Path;

use half::f16;
use npyz::WriterBuilder;

use super::array::Scalar;
use super::sidecar::{Sidecar, is_sidecar, sidecar_path};
use crate::error::{Error, Result};
use crate::file::output::{check_target, write_atomically, write_bytes};

/// Shape and place of a capture that is to be written.
pub struct CaptureWriter<'a> {
    /// The `.npy` file.
    pub path: &'a Path,
    /// Pixels in x and y.
    pub size: [usize; 2],
    /// R: windows have D = 2 R + 1 pixels to a side.
    pub radius: usize,
    /// Element type.
    pub scalar: Scalar,
    /// What goes beside the array.
    pub sidecar: &'a Sidecar,
}

/// Whether a capture can be written to `path`, and its sidecar beside it.
///
/// # Errors
/// [`Error::Request`] if one of them cannot, if both are the same file, or if what would be the sidecar is there and is
/// something else.
pub fn check_capture_target(path: &Path) -> Result<()> {
    let refuse = |what: &str| Err(Error::Request(format!("{}: {what}; name the array .npy", path.display())));
    match path.extension().and_then(|extension| extension.to_str()) {
        Some("json") => return refuse(".json is for the facts beside the array"),
        Some("npz") => return refuse("archives are read, not written"),
        _ => {}
    }
    check_target(path)?;
    let sidecar = sidecar_path(path);
    check_target(&sidecar)?;
    match std::fs::read(&sidecar) {
        Ok(bytes) if !is_sidecar(&bytes) => {
            let (sidecar, path) = (sidecar.display(), path.display());
            Err(Error::Request(format!(
                "{sidecar}: is there and is no sidecar of a capture; {path} would need that name: choose another"
            )))
        }
        _ => Ok(()),
    }
}

impl CaptureWriter<'_> {
    /// Writes array and sidecar. `rows` is called once with a sink that takes whole rows of windows in order,
    /// `[x][dy][dx][rgb]` in mm⁻², as many at a time as the caller likes.
    ///
    /// # Errors
    /// As [`check_capture_target`], and [`Error::Output`]; a file is there whole or as it was before.
    pub fn write(&self, rows: impl FnOnce(&mut dyn FnMut(&[f32]) -> io::Result<()>) -> io::Result<()>) -> Result<()> {
        check_capture_target(self.path)?;
        let [width, height] = self.size;
        let d = 2 * self.radius + 1;
        let shape = [height, width, d, d, 3].map(|n| n as u64);
        write_atomically(self.path, |file| match self.scalar {
            Scalar::F32 => write_as(file, &shape, rows, |value| value),
            Scalar::F16 => write_as(file, &shape, rows, f16::from_f32),
        })?;
        write_bytes(&sidecar_path(self.path), self.sidecar.to_json().as_bytes())
    }
}

fn write_as<T: npyz::AutoSerialize>(
    file: &mut dyn Write,
    shape: &[u64],
    rows: impl FnOnce(&mut dyn FnMut(&[f32]) -> io::Result<()>) -> io::Result<()>,
    convert: impl Fn(f32) -> T,
) -> io::Result<()> {
    let mut array = npyz::WriteOptions::new().default_dtype().shape(shape).writer(file).begin_nd()?;
    rows(&mut |values| array.extend(values.iter().map(|&value| convert(value))))?;
    array.finish()
}
