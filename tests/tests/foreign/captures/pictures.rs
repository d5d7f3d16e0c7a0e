//! Pictures of every format come out as they went in, upright, with their values.

use std::path::{Path, PathBuf};

use image::{DynamicImage, ImageFormat, Rgb, Rgb32FImage, RgbImage};
use subsurf_encoder::picture::{Header, Picture, PixelFormat};

/// A picture no two of whose corners are alike, 48 × 32 pixels in blocks of 8, so that JPEG changes little.
pub(super) fn blocks() -> RgbImage {
    RgbImage::from_fn(48, 32, |x, y| {
        let value = |k: u32| u8::try_from(k * 255 / 10).expect("0 to 255");
        Rgb([value(x / 8 + 2), value(y / 8 * 2 + 1), value((x / 8 + y / 8) % 5 + 3)])
    })
}

pub(super) fn encoded(image: impl Into<DynamicImage>, format: ImageFormat) -> Vec<u8> {
    let mut bytes = std::io::Cursor::new(Vec::new());
    image.into().write_to(&mut bytes, format).expect("memory can be written to");
    bytes.into_inner()
}

/// Linear values that a Radiance file holds exactly.
pub(super) fn linear() -> Rgb32FImage {
    Rgb32FImage::from_fn(6, 4, |x, y| {
        let value = |k: u32| k as f32 / 8.0;
        Rgb([value(x + 1), value(y + 2), value(x * y + 3)])
    })
}

/// A Radiance file of flat pixels; `order` is the line that tells size and order of scanlines, `at` which pixel of the
/// picture a place in the file holds.
pub(super) fn radiance(picture: &Rgb32FImage, order: &str, at: impl Fn(u32, u32) -> [u32; 2], n: [u32; 2]) -> Vec<u8> {
    let mut file = format!("#?RADIANCE\n# a comment\nFORMAT=32-bit_rle_rgbe\n\n{order}\n").into_bytes();
    for (scanline, place) in (0..n[0]).flat_map(|scanline| (0..n[1]).map(move |place| (scanline, place))) {
        let [x, y] = at(scanline, place);
        // Values are below 4: steps of 4 / 256.
        let mantissas = picture.get_pixel(x, y).0.map(|value| value * 64.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255")]
        file.extend(mantissas.map(|mantissa| mantissa as u8));
        file.push(130);
    }
    file
}

pub(super) fn write(folder: &Path, name: &str, bytes: &[u8]) -> PathBuf {
    let path = folder.join(name);
    std::fs::write(&path, bytes).unwrap();
    path
}

/// The largest difference of a picture from what it should be.
fn difference(path: &Path, size: [u32; 2], expected: impl Fn(u32, u32) -> [f32; 3]) -> f32 {
    let picture = Picture::open(path).unwrap();
    assert_eq!(picture.size(), size, "{}", path.display());
    assert_eq!(Header::open(path).unwrap().size, size, "{}", path.display());
    let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    let pairs = picture.pixels().iter().zip(places);
    let differences = pairs.flat_map(|(found, (x, y))| {
        let expected = expected(x, y);
        [0, 1, 2].map(|c| (found[c] - expected[c]).abs())
    });
    differences.fold(0.0, f32::max)
}

#[test]
fn integers_are_display_values_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let image = blocks();
    let expected = |x: u32, y: u32| image.get_pixel(x, y).0.map(|value| f32::from(value) / 255.0);
    let rgba = DynamicImage::from(image.clone()).into_rgba8();
    let deep = DynamicImage::from(image.clone()).into_rgb16();
    for (name, bytes, tolerance) in [
        ("a.png", encoded(image.clone(), ImageFormat::Png), 0.0),
        ("a.bmp", encoded(image.clone(), ImageFormat::Bmp), 0.0),
        ("a.tga", encoded(image.clone(), ImageFormat::Tga), 0.0),
        ("a.TIF", encoded(image.clone(), ImageFormat::Tiff), 0.0),
        ("a.webp", encoded(image.clone(), ImageFormat::WebP), 0.0),
        ("a.jpg", encoded(image.clone(), ImageFormat::Jpeg), 0.06),
        ("rgba.png", encoded(rgba.clone(), ImageFormat::Png), 0.0),
        ("rgba.tga", encoded(rgba, ImageFormat::Tga), 0.0),
        ("deep.png", encoded(deep.clone(), ImageFormat::Png), 1e-6),
        ("deep.tiff", encoded(deep, ImageFormat::Tiff), 1e-6),
        // What a file is, its content says.
        ("png.jpg", encoded(image.clone(), ImageFormat::Png), 0.0),
        ("png", encoded(image.clone(), ImageFormat::Png), 0.0),
    ] {
        let path = write(folder.path(), name, &bytes);
        let found = difference(&path, [48, 32], expected);
        assert!(found <= tolerance, "{name}: off by {found}");
        let header = Header::open(&path).unwrap();
        let format = if name.starts_with("deep") { PixelFormat::Display16 } else { PixelFormat::Display8 };
        assert_eq!(header.format, format, "{name}");
    }
}

#[test]
fn sixteen_bits_stay_sixteen_bits() {
    let folder = tempfile::tempdir().unwrap();
    let deep =
        image::ImageBuffer::<Rgb<u16>, _>::from_fn(9, 5, |x, y| Rgb([30_000 + 7 * u16::try_from(x * y).unwrap(); 3]));
    let grey =
        image::ImageBuffer::<image::Luma<u16>, _>::from_fn(9, 5, |x, y| image::Luma([deep.get_pixel(x, y).0[0]]));
    for (name, bytes) in [
        ("deep.png", encoded(deep.clone(), ImageFormat::Png)),
        ("deep.tif", encoded(deep.clone(), ImageFormat::Tiff)),
        ("grey.png", encoded(grey, ImageFormat::Png)),
    ] {
        let path = write(folder.path(), name, &bytes);
        let expected = |x, y| deep.get_pixel(x, y).0.map(|value| f32::from(value) / 65_535.0);
        assert!(difference(&path, [9, 5], expected) < 1e-7, "{name}");
    }
}

#[test]
fn floats_are_linear_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let image = linear();
    let row_by_row = |y: u32, x: u32| [x, y];
    for (name, bytes) in [
        ("a.exr", encoded(image.clone(), ImageFormat::OpenExr)),
        ("a.tif", encoded(image.clone(), ImageFormat::Tiff)),
        ("a.hdr", radiance(&image, "-Y 4 +X 6", row_by_row, [4, 6])),
        ("a.pic", radiance(&image, "-Y 4 +X 6", row_by_row, [4, 6])),
    ] {
        let path = write(folder.path(), name, &bytes);
        assert!(Header::open(&path).unwrap().format.is_linear(), "{name}");
        assert_eq!(difference(&path, [6, 4], |x, y| image.get_pixel(x, y).0), 0.0, "{name}");
        let as_it_is = Picture::open(&path).unwrap();
        assert_eq!(as_it_is.pixels(), as_it_is.clone().into_linear().pixels(), "{name}");
    }
}

/// A TIFF file of one float for each pixel; `is_large` for 64-bit offsets.
pub(super) fn grey_tiff(picture: &Rgb32FImage, is_large: bool) -> Vec<u8> {
    use tiff::encoder::TiffEncoder;
    use tiff::encoder::colortype::Gray32Float;

    let values: Vec<f32> = picture.pixels().map(|rgb| rgb.0[0]).collect();
    let (width, height) = picture.dimensions();
    let mut bytes = std::io::Cursor::new(Vec::new());
    let written = if is_large {
        TiffEncoder::new_big(&mut bytes).and_then(|mut file| file.write_image::<Gray32Float>(width, height, &values))
    } else {
        TiffEncoder::new(&mut bytes).and_then(|mut file| file.write_image::<Gray32Float>(width, height, &values))
    };
    written.expect("memory can be written to");
    bytes.into_inner()
}

/// An OpenEXR file of channels of floats.
fn exr<const N: usize>(size: [u32; 2], channels: [(&str, Vec<f32>); N]) -> Vec<u8> {
    use exr::prelude::{AnyChannel, AnyChannels, FlatSamples, Image, SmallVec, Text, WritableImage};

    let channel = |(name, values)| AnyChannel::new(Text::from(name), FlatSamples::F32(values));
    let channels: SmallVec<[_; 4]> = channels.map(channel).into_iter().collect();
    let mut bytes = std::io::Cursor::new(Vec::new());
    let image = Image::from_channels((size[0] as usize, size[1] as usize), AnyChannels::sort(channels));
    image.write().to_buffered(&mut bytes).expect("memory can be written to");
    bytes.into_inner()
}

/// An OpenEXR file of luminance alone.
pub(super) fn grey_exr(picture: &Rgb32FImage) -> Vec<u8> {
    exr([picture.width(), picture.height()], [("Y", picture.pixels().map(|pixel| pixel.0[0]).collect())])
}

#[test]
fn one_float_for_each_pixel_is_a_picture_too() {
    let folder = tempfile::tempdir().unwrap();
    let image = linear();
    for (name, bytes) in
        [("a.tif", grey_tiff(&image, false)), ("large.tif", grey_tiff(&image, true)), ("a.exr", grey_exr(&image))]
    {
        let path = write(folder.path(), name, &bytes);
        assert!(Header::open(&path).unwrap().format.is_linear(), "{name}");
        assert_eq!(difference(&path, [6, 4], |x, y| [image.get_pixel(x, y).0[0]; 3]), 0.0, "{name}");
    }
}

/// Luminance with chroma beside it, which is in fewer pixels, is no picture of grey.
#[test]
fn luminance_and_chroma_are_refused() {
    let bytes = exr([2, 2], ["BY", "RY", "Y"].map(|name| (name, vec![0.5; 4])));
    let folder = tempfile::tempdir().unwrap();
    let path = write(folder.path(), "colour.exr", &bytes);
    let error = Picture::open(&path).unwrap_err().to_string();
    assert!(error.contains("colour.exr") && error.lines().count() == 1, "{error}");
}

/// Large maps of one colour take nearly no bytes.
#[test]
fn one_colour_is_a_picture() {
    let folder = tempfile::tempdir().unwrap();
    let image = RgbImage::from_pixel(4_096, 4_096, Rgb([120, 60, 30]));
    let path = write(folder.path(), "a.webp", &encoded(image, ImageFormat::WebP));
    let header = Header { size: [4_096; 2], format: PixelFormat::Display8 };
    assert_eq!(Header::open(&path).unwrap(), header);
}

#[test]
fn scanlines_may_come_in_any_order() {
    let folder = tempfile::tempdir().unwrap();
    let image = linear();
    let [w, h] = [6, 4];
    type At = Box<dyn Fn(u32, u32) -> [u32; 2]>;
    let orders: [(&str, At, [u32; 2]); 8] = [
        ("-Y 4 +X 6", Box::new(|s, p| [p, s]), [h, w]),
        ("+Y 4 +X 6", Box::new(move |s, p| [p, h - 1 - s]), [h, w]),
        ("-Y 4 -X 6", Box::new(move |s, p| [w - 1 - p, s]), [h, w]),
        ("+Y 4 -X 6", Box::new(move |s, p| [w - 1 - p, h - 1 - s]), [h, w]),
        ("+X 6 -Y 4", Box::new(|s, p| [s, p]), [w, h]),
        ("-X 6 -Y 4", Box::new(move |s, p| [w - 1 - s, p]), [w, h]),
        ("+X 6 +Y 4", Box::new(move |s, p| [s, h - 1 - p]), [w, h]),
        ("-X 6 +Y 4", Box::new(move |s, p| [w - 1 - s, h - 1 - p]), [w, h]),
    ];
    for (order, at, n) in orders {
        let path = write(folder.path(), "a.hdr", &radiance(&image, order, at, n));
        assert_eq!(difference(&path, [w, h], |x, y| image.get_pixel(x, y).0), 0.0, "{order}");
    }
}

/// An EXIF block that says an orientation and nothing else.
fn exif(orientation: u8) -> Vec<u8> {
    let entry = [1, 0x12, 0, 3, 0, 0, 0, 1, 0, orientation, 0, 0];
    [b"MM\0\x2a\0\0\0\x08\0\x01".as_slice(), &entry, &[0; 4]].concat()
}

#[test]
fn exif_says_which_way_is_up() {
    let folder = tempfile::tempdir().unwrap();
    let upright = blocks();
    let [w, h] = [48, 32];
    for orientation in 1..=8_u8 {
        // Which pixel of the upright picture a place of the stored one shows: rows and columns begin at these sides.
        let at = move |x: u32, y: u32| match orientation {
            1 => [x, y],
            2 => [w - 1 - x, y],
            3 => [w - 1 - x, h - 1 - y],
            4 => [x, h - 1 - y],
            5 => [y, x],
            6 => [w - 1 - y, x],
            7 => [w - 1 - y, h - 1 - x],
            _ => [y, h - 1 - x],
        };
        let size = if orientation < 5 { [w, h] } else { [h, w] };
        let stored = RgbImage::from_fn(size[0], size[1], |x, y| {
            let [x, y] = at(x, y);
            *upright.get_pixel(x, y)
        });
        // JPEG: a segment APP1 behind the start of the image.
        let jpeg = encoded(stored.clone(), ImageFormat::Jpeg);
        let block = [b"Exif\0\0".as_slice(), &exif(orientation)].concat();
        let length = u16::try_from(block.len() + 2).unwrap().to_be_bytes();
        let jpeg = [&jpeg[..2], &[0xff, 0xe1], &length, &block, &jpeg[2..]].concat();
        // WebP: chunks VP8X and EXIF around the one of the picture.
        let webp = encoded(stored.clone(), ImageFormat::WebP);
        let sides = size.map(|side| (side - 1).to_le_bytes());
        let chunk = |kind: &[u8], data: &[u8]| {
            let length = u32::try_from(data.len()).unwrap().to_le_bytes();
            [kind, &length, data, &vec![0; data.len() % 2]].concat()
        };
        let extended = chunk(b"VP8X", &[&[8, 0, 0, 0][..], &sides[0][..3], &sides[1][..3]].concat());
        let body = [b"WEBP".as_slice(), &extended, &webp[12..], &chunk(b"EXIF", &exif(orientation))].concat();
        let webp = chunk(b"RIFF", &body);
        for (name, bytes) in [("a.jpg", jpeg), ("a.webp", webp)] {
            let path = write(folder.path(), name, &bytes);
            let expected = |x, y| upright.get_pixel(x, y).0.map(|value| f32::from(value) / 255.0);
            assert!(difference(&path, [w, h], expected) < 0.06, "{name}, orientation {orientation}");
        }
    }
}

#[test]
fn tiff_says_which_way_is_up() {
    use tiff::encoder::TiffEncoder;
    use tiff::encoder::colortype::{Gray32Float, RGB32Float};
    use tiff::tags::Tag;

    let folder = tempfile::tempdir().unwrap();
    let upright = linear();
    // Orientation 6: rows of the file begin at the right.
    let stored = Rgb32FImage::from_fn(4, 6, |x, y| *upright.get_pixel(5 - y, x));
    let grey: Vec<f32> = stored.pixels().map(|rgb| rgb.0[0]).collect();
    let [mut one, mut three] = [(); 2].map(|()| std::io::Cursor::new(Vec::new()));
    let mut file = TiffEncoder::new(&mut one).unwrap();
    let mut image = file.new_image::<Gray32Float>(4, 6).unwrap();
    image.encoder().write_tag(Tag::Orientation, 6_u16).unwrap();
    image.write_data(&grey).unwrap();
    let mut file = TiffEncoder::new(&mut three).unwrap();
    let mut image = file.new_image::<RGB32Float>(4, 6).unwrap();
    image.encoder().write_tag(Tag::Orientation, 6_u16).unwrap();
    image.write_data(stored.as_raw()).unwrap();
    let path = write(folder.path(), "one.tif", &one.into_inner());
    assert_eq!(difference(&path, [6, 4], |x, y| [upright.get_pixel(x, y).0[0]; 3]), 0.0);
    let path = write(folder.path(), "three.tif", &three.into_inner());
    assert_eq!(difference(&path, [6, 4], |x, y| upright.get_pixel(x, y).0), 0.0);
}

#[test]
fn what_is_no_measure_of_light_is_clamped_and_counted() {
    let folder = tempfile::tempdir().unwrap();
    let mut image = linear();
    for (x, value) in [f32::NAN, f32::INFINITY, -1.0, f32::NEG_INFINITY, 1e20].into_iter().enumerate() {
        image.get_pixel_mut(u32::try_from(x).unwrap(), 0).0[1] = value;
    }
    let path = write(folder.path(), "a.exr", &encoded(image, ImageFormat::OpenExr));
    let mut picture = Picture::open(&path).unwrap();
    assert_eq!(picture.largest(), 1e20);
    assert_eq!(picture.clamp(1e10), 5);
    let column: Vec<f32> = picture.pixels()[..5].iter().map(|rgb| rgb[1]).collect();
    assert_eq!(column, [0.0, 1e10, 0.0, 0.0, 1e10]);
    assert_eq!(picture.clamp(1e10), 0, "nothing is left to clamp");

    let mut glass = DynamicImage::from(blocks()).into_rgba8();
    glass.get_pixel_mut(3, 3).0[3] = 100;
    let path = write(folder.path(), "glass.png", &encoded(glass, ImageFormat::Png));
    assert_eq!(Picture::open(&path).unwrap().transparent(), 1);
}
