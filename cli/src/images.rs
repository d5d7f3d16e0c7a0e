//! Images that BTFs were made from, to be drawn and timed beside the files.

use std::path::Path;

use subsurf_decoder::btf::ColourEncoding;
use subsurf_encoder::capture::{Folder, Images};
use subsurf_encoder::{Error, Result};
use subsurf_shaders::cpu;
use subsurf_viewer::BtfImageSet;

use crate::program::progress::Bars;

/// Images of a folder, as a device takes them.
pub struct FolderImages(Images);

impl FolderImages {
    /// Reads all images of a folder.
    ///
    /// # Errors
    /// They cannot be read, some are missing, or they are linear floats.
    pub fn read(folder: &Path) -> Result<Self> {
        let found = Folder::open(folder)?;
        if found.format().is_linear() {
            return Err(Error::Request(format!(
                "{}: linear floats, which take four times the memory of display values; --images draws .png and .jpg",
                folder.display()
            )));
        }
        Ok(Self(Images::load(&found, &Bars::new())?))
    }

    /// Number of pairs of directions, each an image.
    pub fn pairs(&self) -> usize {
        self.0.pairs()
    }
}

impl BtfImageSet for FolderImages {
    fn size(&self) -> [u32; 2] {
        self.0.size()
    }

    fn lights(&self) -> &[glam::Vec3] {
        self.0.lights()
    }

    fn views(&self) -> &[glam::Vec3] {
        self.0.views()
    }

    fn white(&self) -> f32 {
        match self.0.tone() {
            ColourEncoding::Display { white } => white,
            ColourEncoding::LogLuv { .. } => 1.0,
        }
    }

    fn image(&self, light: usize, view: usize) -> Vec<[u8; 3]> {
        self.0.image(light * self.0.views().len() + view).into_iter().map(cpu::display).collect()
    }
}
