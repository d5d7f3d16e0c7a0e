//! Folders as sources of images.

use glam::Vec3;

use super::Folder;
use crate::capture::source::Source;
use crate::error::Result;
use crate::picture::PixelFormat;

impl Source for Folder {
    fn label(&self) -> String {
        self.path().display().to_string()
    }

    fn lights(&self) -> Vec<Vec3> {
        self.lights().iter().map(|light| light.unit()).collect()
    }

    fn views(&self) -> Vec<Vec3> {
        self.views().iter().map(|view| view.unit()).collect()
    }

    fn size(&self) -> [u32; 2] {
        self.size()
    }

    fn format(&self) -> PixelFormat {
        self.format()
    }

    #[allow(clippy::cast_possible_truncation, reason = "an exposure")]
    fn white(&self) -> f32 {
        (1.0 / self.exposure()) as f32
    }

    fn warnings(&self) -> Vec<String> {
        self.warnings().to_vec()
    }

    fn read(&self, light: usize, view: usize) -> Result<Vec<[f32; 3]>> {
        self.read(self.lights()[light], self.views()[view])
    }
}
