//! Writes the images of a BTF.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat, Rgb32FImage, RgbImage};
use tempfile::TempDir;

use crate::capture::directions::{Direction, image_name};
use crate::error::{Error, Result};
use crate::file::output::{PREFIX, Unfinished, check_new_folder, folder_of, write_bytes};

/// Bytes of an image file beside its values, at most.
const FILE_HEADER: u64 = 512;
/// Bytes by which files on disks grow.
const DISK_BLOCK: u64 = 4_096;

/// How values become pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Pixels {
    /// 8-bit sRGB in PNG, of the values times an exposure; what is brighter than 1 is cut off.
    Display {
        /// Factor of all values.
        exposure: f32,
    },
    /// 32-bit linear floats in OpenEXR.
    Linear,
}

impl Pixels {
    fn extension(self) -> &'static str {
        match self {
            Self::Display { .. } => "png",
            Self::Linear => "exr",
        }
    }

    /// Bytes that an image of `side` pixels takes on a disk if nothing of it can be compressed.
    pub(crate) fn most_file_bytes(self, side: u32) -> u64 {
        let row = 3 * u64::from(side);
        let values = match self {
            // A filter for each row.
            Self::Display { .. } => row + 1,
            // An offset, a number and a length for each row.
            Self::Linear => 4 * row + 16,
        };
        (FILE_HEADER + values * u64::from(side)).next_multiple_of(DISK_BLOCK)
    }
}

/// Writes a folder that is there whole or not at all.
pub struct FolderWriter {
    folder: PathBuf,
    unfinished: TempDir,
    _listed: Unfinished,
    side: u32,
    pixels: Pixels,
}

impl FolderWriter {
    /// Begins a folder of square images of `side` pixels.
    ///
    /// # Errors
    /// [`Error::Request`] if something of that name is there already, or nothing can be made beside it; [`Error::Output`]
    /// if it cannot be written.
    pub fn new(folder: &Path, side: u32, pixels: Pixels) -> Result<Self> {
        check_new_folder(folder)?;
        let unfinished = tempfile::Builder::new().prefix(PREFIX).tempdir_in(folder_of(folder));
        let unfinished = unfinished.map_err(|source| Error::output(folder, source))?;
        let listed = Unfinished::new(unfinished.path());
        Ok(Self { folder: folder.to_owned(), unfinished, _listed: listed, side, pixels })
    }

    /// Writes one image, row by row.
    ///
    /// # Errors
    /// [`Error::Output`].
    ///
    /// # Panics
    /// If there are not as many values as pixels.
    pub fn write(&self, light: Direction, view: Direction, values: &[[f32; 3]]) -> Result<()> {
        let side = self.side;
        let path = self.unfinished.path().join(format!("{}.{}", image_name(light, view), self.pixels.extension()));
        let (image, format) = match self.pixels {
            Pixels::Display { exposure } => {
                let bytes = values.iter().flatten().map(|value| display(value * exposure)).collect();
                let image = RgbImage::from_raw(side, side, bytes).map(DynamicImage::from);
                (image, ImageFormat::Png)
            }
            Pixels::Linear => {
                let floats = values.iter().flatten().copied().collect();
                let image = Rgb32FImage::from_raw(side, side, floats).map(DynamicImage::from);
                (image, ImageFormat::OpenExr)
            }
        };
        let mut bytes = Cursor::new(Vec::new());
        let written = image.expect("a value for every pixel").write_to(&mut bytes, format);
        written.map_err(|error| Error::output(&path, std::io::Error::other(error)))?;
        std::fs::write(&path, bytes.into_inner()).map_err(|source| Error::output(&path, source))
    }

    /// Gives the folder its name, with a file `btf.json` that says where the images come from.
    ///
    /// # Errors
    /// [`Error::Output`].
    pub fn finish(self, facts: &serde_json::Value) -> Result<()> {
        write_bytes(&self.unfinished.path().join("btf.json"), format!("{facts:#}\n").as_bytes())?;
        let output = |source| Error::output(&self.folder, source);
        std::fs::rename(self.unfinished.path(), &self.folder).map_err(output)?;
        // It has another name now: there is nothing to remove.
        drop(self.unfinished.keep());
        Ok(())
    }
}

/// IEC 61966-2-1, in 8 bits.
fn display(value: f32) -> u8 {
    let value = value.clamp(0.0, 1.0);
    let encoded = if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 };
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
    let byte = (255.0 * encoded).round() as u8;
    byte
}
