//! Pictures that others made, read in one way: maps, environments, images of BTFs.

mod decode;
mod format;
mod grey;
mod jpeg;
mod radiance;
mod tiff_tags;

use std::path::Path;

use image::Rgb32FImage;
use image::imageops::{FilterType, resize};

use crate::error::Result;
use decode::Decoder;
pub use format::PixelFormat;

/// Extensions of files that [`Picture::open`] reads, in lower case. What a file is, its content says, or its name where
/// the content has no signature.
pub const EXTENSIONS: [&str; 10] = ["png", "jpg", "jpeg", "exr", "hdr", "tif", "tiff", "tga", "webp", "bmp"];

/// Facts that the header of a picture states.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// Pixels in x and in y, upright.
    pub size: [u32; 2],
    /// What pixels are.
    pub format: PixelFormat,
}

/// A picture in memory, upright: EXIF orientation and the order of scanlines are applied.
#[derive(Clone, Debug)]
pub struct Picture {
    image: Rgb32FImage,
    header: Header,
    transparent: u64,
}

impl Header {
    /// Reads what stands before the pixels.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if it is no picture.
    pub fn open(path: &Path) -> Result<Self> {
        Ok(Decoder::open(path)?.header())
    }
}

impl Picture {
    /// Reads a PNG, JPEG, WebP, TIFF, TGA, BMP, Radiance HDR or OpenEXR file. Alpha is left out.
    ///
    /// # Errors
    /// [`Error::Input`](crate::Error::Input) if it is no picture or a broken one, [`Error::Request`](crate::Error::Request)
    /// if it takes more memory than there is.
    pub fn open(path: &Path) -> Result<Self> {
        Decoder::open(path)?.decode()
    }

    /// Pixels in x and in y.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        self.header.size
    }

    /// Whether values are linear Rec. 709; display values (sRGB), 0 to 1, otherwise.
    #[must_use]
    pub fn is_linear(&self) -> bool {
        self.header.format.is_linear()
    }

    /// Number of pixels that are not opaque in the file; their colour is taken as it stands.
    #[must_use]
    pub fn transparent(&self) -> u64 {
        self.transparent
    }

    /// Values as they are stored, row by row from the top; those of 8 or 16 bits are 0 to 1.
    #[must_use]
    pub fn pixels(&self) -> &[[f32; 3]] {
        self.image.as_raw().as_chunks().0
    }

    /// The largest value that is finite; 0 if none is positive.
    #[must_use]
    pub fn largest(&self) -> f32 {
        self.image.as_raw().iter().copied().filter(|value| value.is_finite()).fold(0.0, f32::max)
    }

    /// Brings all values into 0 to `largest`; NaN becomes 0. Returns how many pixels that changed.
    pub fn clamp(&mut self, largest: f32) -> u64 {
        let mut changed = 0;
        for pixel in self.image.pixels_mut() {
            if pixel.0.iter().all(|value| (0.0..=largest).contains(value)) {
                continue;
            }
            changed += 1;
            pixel.0 = pixel.0.map(|value| if value.is_nan() { 0.0 } else { value.clamp(0.0, largest) });
        }
        changed
    }

    /// The same picture in linear Rec. 709.
    #[must_use]
    pub fn into_linear(mut self) -> Self {
        if !self.is_linear() {
            for pixel in self.image.pixels_mut() {
                pixel.0 = pixel.0.map(from_srgb);
            }
            self.header.format = PixelFormat::Linear;
        }
        self
    }

    /// The same picture at another size, its values averaged where it shrinks and interpolated where it grows.
    #[must_use]
    pub fn resized(&self, [width, height]: [u32; 2]) -> Self {
        // A triangle as wide as a target pixel.
        let image = resize(&self.image, width, height, FilterType::Triangle);
        Self { image, header: Header { size: [width, height], ..self.header }, transparent: self.transparent }
    }
}

/// Linear value of an sRGB one (IEC 61966-2-1), 0 to 1.
fn from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
