//! From a file to a picture.

use std::fmt::Display;
use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, Limits};

use super::radiance::{self, Layout};
use super::{Header, Picture};
use crate::error::{Error, Result};
use crate::memory;

const EXPECTED: &str = "an image (PNG, JPEG, WebP, TIFF, TGA, BMP, Radiance HDR or OpenEXR)";

/// Pixels that a byte of a file may stand for: more than any format brings to it in practice.
const PIXELS_OF_BYTE: u64 = 16_384;
/// Bytes of memory for a pixel while it is decoded: as it is stored, as floats with alpha, and as floats.
const BYTES_OF_PIXEL: u64 = 44;

/// A file whose header was read, and whose pixels come next.
pub(super) struct Decoder {
    path: PathBuf,
    source: Source,
    header: Header,
    orientation: Orientation,
}

enum Source {
    Radiance(BufReader<File>, Layout),
    Other(Box<dyn ImageDecoder>),
}

impl Decoder {
    pub(super) fn open(path: &Path) -> Result<Self> {
        let wrong = |error: String| Error::input(path, error, EXPECTED);
        let file = File::open(path).map_err(|error| wrong(error.to_string()))?;
        let file_bytes = file.metadata().map_or(0, |metadata| metadata.len());
        let mut file = BufReader::new(file);
        // Many programs sign their files "#?RGBE" instead of "#?RADIANCE".
        let is_radiance = file.fill_buf().map_err(|error| wrong(error.to_string()))?.starts_with(b"#?");
        let (source, [width, height], is_linear, is_deep, orientation) = if is_radiance {
            let layout = radiance::read_header(&mut file).map_err(wrong)?;
            (Source::Radiance(file, layout), layout.scanlines, true, false, layout.orientation)
        } else {
            let mut decoder = other(path, file)?;
            let colour = decoder.color_type();
            let (bytes, channels) = (colour.bytes_per_pixel(), colour.channel_count());
            let [is_linear, is_deep] = [4, 2].map(|wide| bytes == wide * channels);
            let (width, height) = decoder.dimensions();
            // What cannot be read of EXIF is not there.
            let orientation = decoder.orientation().unwrap_or(Orientation::NoTransforms);
            (Source::Other(decoder), [width, height], is_linear, is_deep, orientation)
        };
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || pixels / PIXELS_OF_BYTE > file_bytes {
            return Err(wrong(format!("{width} × {height} pixels in a file of {file_bytes} bytes")));
        }
        let size = if is_on_its_side(orientation) { [height, width] } else { [width, height] };
        Ok(Self { path: path.to_owned(), source, header: Header { size, is_linear, is_deep }, orientation })
    }

    pub(super) fn header(&self) -> Header {
        self.header
    }

    pub(super) fn decode(self) -> Result<Picture> {
        let Self { path, source, header, orientation } = self;
        let [width, height] = header.size;
        let pixels = u64::from(width) * u64::from(height);
        let what = || format!("{}: a picture of {width} × {height} pixels", path.display());
        memory::expect(pixels.saturating_mul(BYTES_OF_PIXEL), what)?;
        let wrong = |error: String| Error::input(&path, error, EXPECTED);
        let mut image = match source {
            Source::Radiance(mut file, layout) => {
                radiance::read_scanlines(&mut file, layout.scanlines).map_err(wrong)?.into()
            }
            Source::Other(decoder) => DynamicImage::from_decoder(decoder).map_err(|error| wrong(one_line(error)))?,
        };
        image.apply_orientation(orientation);
        let mut transparent = 0;
        if image.color().has_alpha() {
            let with_alpha = image.into_rgba32f();
            transparent = with_alpha.pixels().filter(|pixel| pixel.0[3] < 1.0).count() as u64;
            image = with_alpha.into();
        }
        Ok(Picture { image: image.into_rgb32f(), header, transparent })
    }
}

/// Decoder of a format that the library reads.
fn other(path: &Path, file: BufReader<File>) -> Result<Box<dyn ImageDecoder>> {
    let wrong = |error: String| Error::input(path, error, EXPECTED);
    let mut reader = ImageReader::new(file).with_guessed_format().map_err(|error| wrong(error.to_string()))?;
    if reader.format().is_none() {
        // TGA has no signature.
        match path.extension().and_then(ImageFormat::from_extension) {
            Some(ImageFormat::Tga) => reader.set_format(ImageFormat::Tga),
            _ => return Err(wrong("not of a known format".to_owned())),
        }
    }
    // What the pixels take is checked before they are read.
    let mut limits = Limits::no_limits();
    limits.max_alloc = memory::available();
    reader.limits(limits);
    Ok(Box::new(reader.into_decoder().map_err(|error| wrong(one_line(error)))?))
}

fn is_on_its_side(orientation: Orientation) -> bool {
    use Orientation::{Rotate90, Rotate90FlipH, Rotate270, Rotate270FlipH};
    matches!(orientation, Rotate90 | Rotate90FlipH | Rotate270 | Rotate270FlipH)
}

fn one_line(error: impl Display) -> String {
    error.to_string().split_whitespace().collect::<Vec<_>>().join(" ")
}
