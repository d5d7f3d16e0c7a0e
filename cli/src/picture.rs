//! Picture files, and pictures side by side.

use std::io::Cursor;
use std::path::Path;

use image::codecs::jpeg::JpegEncoder;
use image::{ImageFormat, Rgb, RgbImage};
use subsurf_encoder::metrics::bssrdf::Relit;
use subsurf_encoder::{check_target, write_bytes};

use crate::program::failure::bad_request;

/// Display values, row by row, as an image.
pub fn image(pixels: &[[u8; 3]], width: u32) -> RgbImage {
    let height = u32::try_from(pixels.len()).unwrap_or(0) / width;
    RgbImage::from_fn(width, height, |x, y| Rgb(pixels[(y * width + x) as usize]))
}

/// Quality of JPEG files, 1 to 100.
const JPEG_QUALITY: u8 = 95;

/// The format that a picture is written in, by the extension of its name; PNG if there is none.
fn format_of(path: &Path) -> anyhow::Result<ImageFormat> {
    use ImageFormat::{Bmp, Jpeg, Png, Tga, Tiff, WebP};
    let Some(extension) = path.extension() else {
        return Ok(Png);
    };
    match ImageFormat::from_extension(extension) {
        Some(format @ (Bmp | Jpeg | Png | Tga | Tiff | WebP)) => Ok(format),
        _ => Err(bad_request(format!(
            "{}: pictures are written as .png, .jpg, .tif, .webp, .bmp or .tga",
            path.display()
        ))),
    }
}

/// Whether a picture can be written to `path`.
///
/// # Errors
/// As [`check_target`], and if its extension is that of no format that is written.
pub fn check_picture_target(path: &Path) -> anyhow::Result<()> {
    format_of(path)?;
    Ok(check_target(path)?)
}

/// Writes a picture, whole or not at all, in the format of its extension: PNG, JPEG, TIFF, WebP, BMP or TGA.
///
/// # Errors
/// As [`check_picture_target`], and if it cannot be written.
pub fn write_picture(path: &Path, image: &RgbImage) -> anyhow::Result<()> {
    let mut bytes = Cursor::new(Vec::new());
    match format_of(path)? {
        ImageFormat::Jpeg => image.write_with_encoder(JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY))?,
        format => image.write_to(&mut bytes, format)?,
    }
    Ok(write_bytes(path, &bytes.into_inner())?)
}

/// Width of the light grey between pictures, in pixels.
const GAP: u32 = 6;
const PAPER: Rgb<u8> = Rgb([235; 3]);

/// Puts pictures of equal size into rows.
pub fn montage(rows: &[Vec<RgbImage>]) -> RgbImage {
    let (width, height) = rows.first().and_then(|row| row.first()).map_or((1, 1), RgbImage::dimensions);
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let count = |n: usize| u32::try_from(n).unwrap_or(0);
    let mut sheet =
        RgbImage::from_pixel(count(columns) * (width + GAP) + GAP, count(rows.len()) * (height + GAP) + GAP, PAPER);
    for (y, row) in rows.iter().enumerate() {
        for (x, picture) in row.iter().enumerate() {
            let [x, y] = [(x, width), (y, height)].map(|(k, side)| i64::from(count(k) * (side + GAP) + GAP));
            image::imageops::replace(&mut sheet, picture, x, y);
        }
    }
    sheet
}

/// Linear values 0 to 1 as sRGB, every pixel a block of `scale` × `scale`.
pub fn linear(pixels: &[[f64; 3]], width: u32, scale: u32) -> RgbImage {
    #[allow(clippy::cast_possible_truncation, reason = "display values")]
    let bytes: Vec<[u8; 3]> = pixels
        .iter()
        .map(|rgb| subsurf_shaders::cpu::display(subsurf_shaders::cpu::srgb(rgb.map(|value| value as f32))))
        .collect();
    enlarge(&image(&bytes, width), scale)
}

/// Display values as they are, or linear ones times an exposure as sRGB; at least 256 pixels wide.
pub fn display(pixels: &[[f32; 3]], width: u32, exposure: Option<f32>) -> RgbImage {
    let shown = |rgb: &[f32; 3]| match exposure {
        Some(exposure) => subsurf_shaders::cpu::srgb(rgb.map(|value| exposure * value)),
        None => *rgb,
    };
    let bytes: Vec<[u8; 3]> = pixels.iter().map(|rgb| subsurf_shaders::cpu::display(shown(rgb))).collect();
    enlarge(&image(&bytes, width), (256 / width.max(1)).max(1))
}

fn enlarge(picture: &RgbImage, scale: u32) -> RgbImage {
    let (width, height) = picture.dimensions();
    image::imageops::resize(picture, width * scale, height * scale, image::imageops::FilterType::Nearest)
}

/// Original, file, and ten times their difference, on linear values divided by the original's largest.
pub(crate) fn triptych(relit: &Relit, width: usize) -> Vec<RgbImage> {
    let width = u32::try_from(width).unwrap_or(1);
    let scale = (256 / width.max(1)).max(1);
    // Where nothing is lit, both are black.
    let normalised = relit.normalised().unwrap_or_else(|| relit.clone());
    let pairs = normalised.reference.iter().zip(&normalised.image);
    let difference: Vec<[f64; 3]> = pairs.map(|(a, b)| [0, 1, 2].map(|c| 10.0 * (a[c] - b[c]).abs())).collect();
    vec![
        linear(&normalised.reference, width, scale),
        linear(&normalised.image, width, scale),
        // Differences are shown linearly: what looks half as bright is half as large.
        enlarge(&grey_levels(&difference, width), scale),
    ]
}

fn grey_levels(pixels: &[[f64; 3]], width: u32) -> RgbImage {
    #[allow(clippy::cast_possible_truncation, reason = "display values")]
    let bytes: Vec<[u8; 3]> =
        pixels.iter().map(|rgb| subsurf_shaders::cpu::display(rgb.map(|value| value as f32))).collect();
    image(&bytes, width)
}
