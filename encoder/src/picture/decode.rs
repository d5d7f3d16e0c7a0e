//! From a file to a picture.

use std::fs::File;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};

use image::metadata::Orientation;
use image::{DynamicImage, ImageDecoder, ImageFormat, ImageReader, ImageResult, Limits, Rgb32FImage};

use super::grey::Grey;
use super::jpeg;
use super::radiance::{self, Layout};
use super::tiff_tags;
use super::{EXTENSIONS, Header, Picture, PixelFormat};
use crate::error::{Error, Result};
use crate::memory;

const EXPECTED: &str = "an image (PNG, JPEG, WebP, TIFF, TGA, BMP, Radiance HDR or OpenEXR)";

/// Pixels that a byte of a file may stand for: more than any format brings to it in practice.
const PIXELS_OF_BYTE: u64 = 16_384;
/// Bytes that a decoder may take for what stands before the pixels, such as colour profiles.
const HEADER_BYTES: u64 = 1 << 28;
/// Bytes of memory for a pixel while it is decoded: as it is stored, as floats with alpha, and as floats.
const BYTES_OF_PIXEL: u64 = 44;

/// A file whose header was read, and whose pixels come next.
pub(super) struct Decoder {
    path: PathBuf,
    source: Source,
    /// Pixels in x and in y as they are stored.
    stored: [u32; 2],
    orientation: Orientation,
    format: PixelFormat,
}

/// What reads the pixels.
enum Source {
    Radiance(BufReader<File>, Layout),
    Grey(Grey),
    Other(ImageFormat, Box<dyn ImageDecoder>),
}

impl Decoder {
    pub(super) fn open(path: &Path) -> Result<Self> {
        let wrong = |error: String| Error::input(path, error, EXPECTED);
        // Readers go back and forth, which pipes and devices do not do.
        let found = std::fs::metadata(path).map_err(|error| wrong(error.to_string()))?;
        if !found.is_file() {
            return Err(wrong("not a file".to_owned()));
        }
        let file_bytes = found.len();
        let file = File::open(path).map_err(|error| wrong(error.to_string()))?;
        let mut source = source(path, BufReader::new(file)).map_err(wrong)?;
        let stored = match &source {
            Source::Radiance(_, layout) => layout.scanlines,
            Source::Grey(grey) => grey.size(),
            Source::Other(_, decoder) => decoder.dimensions().into(),
        };
        let pixels = stored.map(u64::from).iter().product::<u64>();
        // Those of one colour take no bytes in WebP, which is limited to 16,384 pixels to a side.
        let is_limited = matches!(source, Source::Other(ImageFormat::WebP, _));
        if pixels == 0 || !is_limited && pixels / PIXELS_OF_BYTE > file_bytes {
            return Err(wrong(format!("{} × {} pixels in a file of {file_bytes} bytes", stored[0], stored[1])));
        }
        let orientation = match &mut source {
            Source::Radiance(_, layout) => layout.orientation,
            Source::Grey(grey) => grey.orientation(),
            // What cannot be read of EXIF is not there.
            Source::Other(_, decoder) => decoder.orientation().unwrap_or(Orientation::NoTransforms),
        };
        let format = match &source {
            Source::Radiance(..) | Source::Grey(_) => PixelFormat::Linear,
            Source::Other(_, decoder) => {
                let colour = decoder.color_type();
                match colour.bytes_per_pixel() / colour.channel_count() {
                    4.. => PixelFormat::Linear,
                    2.. => PixelFormat::Display16,
                    _ => PixelFormat::Display8,
                }
            }
        };
        Ok(Self { path: path.to_owned(), source, stored, orientation, format })
    }

    pub(super) fn header(&self) -> Header {
        let [width, height] = self.stored;
        let size = if is_on_its_side(self.orientation) { [height, width] } else { self.stored };
        Header { size, format: self.format }
    }

    pub(super) fn decode(self) -> Result<Picture> {
        let header = self.header();
        let Self { path, source, stored: [width, height], orientation, .. } = self;
        let need = u64::from(width).saturating_mul(u64::from(height)).saturating_mul(BYTES_OF_PIXEL);
        memory::expect(need, || format!("{}: a picture of {width} × {height} pixels", path.display()))?;
        let wrong = |error: String| Error::input(&path, error, EXPECTED);
        let mut image = match source {
            Source::Radiance(mut file, layout) => {
                radiance::read_scanlines(&mut file, layout.scanlines).map_err(wrong)?.into()
            }
            Source::Grey(grey) => {
                let values = grey.decode().map_err(|error| wrong(error.to_string()))?;
                let values = values.into_iter().flat_map(|value| [value; 3]).collect();
                let image = Rgb32FImage::from_raw(width, height, values);
                image.ok_or_else(|| wrong("fewer values than pixels".to_owned()))?.into()
            }
            Source::Other(format, decoder) => {
                if format == ImageFormat::Jpeg && !jpeg::is_whole(&path).map_err(|error| wrong(error.to_string()))? {
                    return Err(wrong("the file is cut: its pixels have no end".to_owned()));
                }
                decode(decoder).map_err(|error| wrong(error.to_string()))?
            }
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

/// The pixels, whose memory was checked.
fn decode(mut decoder: Box<dyn ImageDecoder>) -> ImageResult<DynamicImage> {
    decoder.set_limits(Limits::no_limits())?;
    DynamicImage::from_decoder(decoder)
}

/// What reads a file, or what is wrong with it.
fn source(path: &Path, mut file: BufReader<File>) -> std::result::Result<Source, String> {
    // Many programs sign their files "#?RGBE" instead of "#?RADIANCE".
    if file.fill_buf().map_err(|error| error.to_string())?.starts_with(b"#?") {
        let layout = radiance::read_header(&mut file)?;
        return Ok(Source::Radiance(file, layout));
    }
    let mut reader = ImageReader::new(file).with_guessed_format().map_err(|error| error.to_string())?;
    // TGA has no signature, and that of large TIFF files is not known.
    let named = path.extension().and_then(|extension| {
        let is_read = EXTENSIONS.contains(&extension.to_str()?.to_ascii_lowercase().as_str());
        ImageFormat::from_extension(extension).filter(|_| is_read)
    });
    let format = reader.format().or(named).ok_or("not of a known format")?;
    reader.set_format(format);
    if let Some(found) = (format == ImageFormat::Tiff).then(|| tiff_tags::unread(path)).flatten() {
        return Err(found.to_owned());
    }
    let mut limits = Limits::no_limits();
    limits.max_alloc = Some(HEADER_BYTES);
    reader.limits(limits);
    match reader.into_decoder() {
        Ok(decoder) => Ok(Source::Other(format, Box::new(decoder))),
        Err(error) => {
            let again = File::open(path).map_err(|error| error.to_string())?;
            Grey::open(format, BufReader::new(again)).map(Source::Grey).ok_or_else(|| error.to_string())
        }
    }
}

fn is_on_its_side(orientation: Orientation) -> bool {
    use Orientation::{Rotate90, Rotate90FlipH, Rotate270, Rotate270FlipH};
    matches!(orientation, Rotate90 | Rotate90FlipH | Rotate270 | Rotate270FlipH)
}
