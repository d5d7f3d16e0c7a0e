//! A simulated BTF from request to folder.

use std::path::Path;

use serde_json::{Value, json};

use super::draw::{bytes_of_pixel, simulate};
use super::samples::Sample;
use crate::capture::{Folder, FolderWriter, Pixels, bonn};
use crate::error::{Error, Result};
use crate::file::output::expect_space;
use crate::memory;
use crate::progress::Progress;

/// A folder of images to be simulated and written.
#[derive(Clone, Copy, Debug)]
pub struct Request {
    /// Built-in material.
    pub sample: Sample,
    /// Pixels in x and in y, 8 to 1,024.
    pub size: u32,
    /// How values become pixels.
    pub pixels: Pixels,
    /// Seed of the pattern.
    pub seed: u64,
}

impl Request {
    /// Whether it can be simulated.
    ///
    /// # Errors
    /// [`Error::Request`] for what is out of range, by the names that the command has for it.
    pub fn check(&self) -> Result<()> {
        if !(8..=1_024).contains(&self.size) {
            return Err(Error::Request(format!("--size is {}; it may be 8 to 1024", self.size)));
        }
        match self.pixels {
            Pixels::Display { exposure } if !(exposure.is_finite() && exposure > 0.0) => {
                Err(Error::Request(format!("--exposure is {exposure}; it must be positive")))
            }
            _ => Ok(()),
        }
    }

    /// What `btf.json` says of the images.
    fn facts(&self) -> Value {
        let exposure = match self.pixels {
            Pixels::Display { exposure } => exposure,
            Pixels::Linear => 1.0,
        };
        json!({
            "simulated": {
                "by": concat!("subsurf ", env!("CARGO_PKG_VERSION")), "sample": self.sample.name(), "seed": self.seed,
                "exposure": exposure,
            },
        })
    }

    /// Refuses what there is no room for, in memory or on the disk of `output`.
    fn expect_room(&self, output: &Path) -> Result<()> {
        let what = || format!("--size {}", self.size);
        let pixels = u64::from(self.size).pow(2);
        memory::expect(pixels * bytes_of_pixel() as u64, what)?;
        let images = (bonn().len() as u64).pow(2);
        expect_space(output, images * self.pixels.most_file_bytes(self.size), what)
    }

    /// Simulates, and writes the folder.
    ///
    /// # Errors
    /// As [`Self::check`] and [`FolderWriter`]; [`Error::Request`] if there is no room for it.
    pub fn write(&self, output: &Path, progress: &dyn Progress) -> Result<()> {
        self.check()?;
        self.expect_room(output)?;
        let writer = FolderWriter::new(output, self.size, self.pixels)?;
        let write = |light, view, image: &[[f32; 3]]| writer.write(light, view, image);
        simulate(self.sample, self.size as usize, self.seed, write, progress)?;
        writer.finish(&self.facts())
    }

    /// Whether a folder is what this would write.
    #[must_use]
    pub fn is_there(&self, output: &Path) -> bool {
        Folder::open(output)
            .is_ok_and(|folder| folder.size() == [self.size; 2] && folder.facts() == Some(&self.facts()))
    }
}
