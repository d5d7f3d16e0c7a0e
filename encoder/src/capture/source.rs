//! What a reader of BTF images has to tell.

use glam::Vec3;

use crate::error::Result;
use crate::picture::PixelFormat;

/// Source of the images of a BTF, an image for every pair of a light and a view.
pub trait Source: Sync {
    /// Name in errors: a path, for example.
    fn label(&self) -> String;
    /// What it is, for people.
    fn kind(&self) -> &'static str {
        "images of a BTF"
    }
    /// Unit vectors towards the lights.
    fn lights(&self) -> Vec<Vec3>;
    /// Unit vectors towards the eyes.
    fn views(&self) -> Vec<Vec3>;
    /// Pixels in x and in y.
    fn size(&self) -> [u32; 2];
    /// What pixels are.
    fn format(&self) -> PixelFormat;
    /// The linear value of display white; of no meaning where pixels are linear.
    fn white(&self) -> f32 {
        1.0
    }
    /// One image, row by row: π times the radiance under light of unit irradiance on a plane that faces it, as display
    /// values or linear. What is below zero, too bright or NaN is counted and clamped by those who take it into memory.
    ///
    /// # Errors
    /// If it cannot be read.
    fn read(&self, light: usize, view: usize) -> Result<Vec<[f32; 3]>>;

    /// What was changed or left out when the source was opened, a line each.
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }

    /// Bytes of what was measured, if images are not it but are made from it.
    fn raw_bytes(&self) -> Option<u64> {
        None
    }
}
