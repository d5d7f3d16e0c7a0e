//! Broken pictures: one line each, whatever is wrong with them.

use image::ImageFormat;
use subsurf_encoder::picture::Picture;
use subsurf_tests::mutate::assert_survives;

use super::pictures::{blocks, encoded, grey_exr, grey_tiff, linear, radiance};

/// A TIFF file of 16 × 16 pixels in a tile for each of three channels.
fn planar_tiles() -> Vec<u8> {
    let (tile, tags) = (256_u32, 11_u16);
    let lists = 8 + 2 + 12 * u32::from(tags) + 4;
    let first = lists + 6 + 12 + 12;
    // Tag, type (3: u16, 4: u32), number of values, value or where they are.
    let entries: [[u32; 4]; 11] = [
        [256, 3, 1, 16],
        [257, 3, 1, 16],
        [258, 3, 3, lists],
        [259, 3, 1, 1],
        [262, 3, 1, 2],
        [277, 3, 1, 3],
        [284, 3, 1, 2],
        [322, 3, 1, 16],
        [323, 3, 1, 16],
        [324, 4, 3, lists + 6],
        [325, 4, 3, lists + 18],
    ];
    let short = |value: u32| u16::try_from(value).expect("small").to_le_bytes();
    let mut file = b"II*\0\x08\0\0\0".to_vec();
    file.extend(tags.to_le_bytes());
    for [tag, kind, count, value] in entries {
        file.extend([short(tag), short(kind)].concat());
        file.extend([count, value].map(u32::to_le_bytes).concat());
    }
    file.extend([0; 4]);
    file.extend([8_u16; 3].map(u16::to_le_bytes).concat());
    file.extend([0, 1, 2].map(|k| (first + k * tile).to_le_bytes()).concat());
    file.extend([tile; 3].map(u32::to_le_bytes).concat());
    file.extend(std::iter::repeat_n(77, 3 * 256));
    file
}

#[test]
fn planar_tiles_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("planar.tif");
    std::fs::write(&path, planar_tiles()).unwrap();
    let error = Picture::open(&path).unwrap_err().to_string();
    assert!(error.contains("tiles for each channel apart"), "{error}");
}

/// They are no floats, though they are as wide.
#[test]
fn integers_of_32_bits_are_refused() {
    use tiff::encoder::TiffEncoder;
    use tiff::encoder::colortype::{Gray32, RGB32};

    let folder = tempfile::tempdir().unwrap();
    let (grey, colour) = (folder.path().join("grey.tif"), folder.path().join("colour.tif"));
    let encoder = |path| TiffEncoder::new(std::fs::File::create(path).unwrap()).unwrap();
    encoder(&grey).write_image::<Gray32>(2, 1, &[1 << 30, 1 << 31]).unwrap();
    encoder(&colour).write_image::<RGB32>(2, 1, &[1 << 30; 6]).unwrap();
    for path in [grey, colour] {
        let error = Picture::open(&path).unwrap_err().to_string();
        assert!(error.contains("integers of 32 bits"), "{error}");
    }
}

#[test]
fn no_mutation_of_a_picture_panics() {
    let small = image::imageops::crop_imm(&blocks(), 4, 4, 16, 12).to_image();
    let deep = image::DynamicImage::from(small.clone()).into_rgb16();
    let integers = |format| encoded(small.clone(), format);
    let row_by_row = |y, x| [x, y];
    let coded =
        [b"#?RGBE\n\n-Y 1 +X 8\n".as_slice(), &[2, 2, 0, 8, 136, 7, 8, 1, 2, 3, 4, 5, 6, 7, 8, 136, 9, 136, 129]];
    for (name, files) in [
        ("a.png", vec![integers(ImageFormat::Png), encoded(deep.clone(), ImageFormat::Png)]),
        ("a.jpg", vec![integers(ImageFormat::Jpeg)]),
        ("a.bmp", vec![integers(ImageFormat::Bmp)]),
        ("a.tga", vec![integers(ImageFormat::Tga)]),
        ("a.webp", vec![integers(ImageFormat::WebP)]),
        (
            "a.tif",
            vec![
                integers(ImageFormat::Tiff),
                encoded(deep, ImageFormat::Tiff),
                encoded(linear(), ImageFormat::Tiff),
                grey_tiff(&linear(), false),
            ],
        ),
        ("a.exr", vec![encoded(linear(), ImageFormat::OpenExr), grey_exr(&linear())]),
        ("a.hdr", vec![radiance(&linear(), "+Y 4 +X 6", row_by_row, [4, 6]), coded.concat()]),
    ] {
        let tally = assert_survives(name, &files, Picture::open);
        println!("{name}: {tally:?}");
    }
}
