//! Broken pictures: one line each, whatever is wrong with them.

use image::ImageFormat;
use subsurf_encoder::picture::Picture;
use subsurf_tests::mutate::assert_survives;

use super::pictures::{blocks, encoded, grey_exr, grey_tiff, linear, radiance};

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
