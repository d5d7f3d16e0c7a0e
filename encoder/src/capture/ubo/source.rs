//! Files of UBO2014 as sources of images.

use glam::Vec3;

use super::Ubo;
use crate::capture::source::Source;
use crate::error::Result;
use crate::picture::PixelFormat;

impl Source for Ubo {
    fn label(&self) -> String {
        self.path().display().to_string()
    }

    fn kind(&self) -> &'static str {
        "compressed BTF of UBO2014"
    }

    fn lights(&self) -> Vec<Vec3> {
        self.lights().to_vec()
    }

    fn views(&self) -> Vec<Vec3> {
        self.views().to_vec()
    }

    fn size(&self) -> [u32; 2] {
        self.size()
    }

    fn format(&self) -> PixelFormat {
        PixelFormat::Linear
    }

    fn read(&self, light: usize, view: usize) -> Result<Vec<[f32; 3]>> {
        let mut image = self.read(light, view)?;
        if !self.has_cosine() {
            let cosine = self.lights()[light].z;
            image.iter_mut().flatten().for_each(|value| *value *= cosine);
        }
        Ok(image)
    }
}
