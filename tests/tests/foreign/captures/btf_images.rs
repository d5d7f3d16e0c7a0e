//! Images of BTFs keep their precision, and what they hold besides measurements is counted.

use std::path::Path;

use image::{ImageFormat, Rgb, Rgb32FImage};
use subsurf_encoder::capture::{Images, load_btf};

use super::pictures::{encoded, write};
use crate::warnings::Warnings;

/// A folder with an image for two lights and two views.
fn load(folder: &Path, extension: &str, image: &[u8]) -> (Images, Vec<String>) {
    for directions in ["tl000 pl000 tv000 pv000", "tl000 pl000 tv030 pv000"] {
        write(folder, &format!("{directions}.{extension}"), image);
        write(folder, &format!("{}.{extension}", directions.replace("tl000", "tl045")), image);
    }
    let warnings = Warnings::default();
    let images = load_btf(folder, &warnings).unwrap();
    (images, warnings.into_lines())
}

#[test]
fn sixteen_bits_stay_sixteen_bits() {
    let value = |x: u32| 20_000 + 3 * u16::try_from(x).unwrap();
    let deep = image::ImageBuffer::<Rgb<u16>, _>::from_fn(8, 8, |x, y| Rgb([value(x), value(y), value(x * y)]));
    for (extension, format) in [("png", ImageFormat::Png), ("tif", ImageFormat::Tiff)] {
        let folder = tempfile::tempdir().unwrap();
        let (images, warnings) = load(folder.path(), extension, &encoded(deep.clone(), format));
        assert!(warnings.is_empty(), "{warnings:?}");
        assert_eq!(images.bytes(), 4 * 8 * 8 * 6, "{extension}");
        for (found, expected) in images.image(3).iter().zip(deep.pixels()) {
            for c in 0..3 {
                let expected = f32::from(expected.0[c]) / 65_535.0;
                assert!((found[c] - expected).abs() < 1e-6, "{extension}: {} is not {expected}", found[c]);
            }
        }
    }
}

#[test]
fn what_is_no_measurement_is_clamped_and_counted() {
    let mut image = Rgb32FImage::from_pixel(8, 8, Rgb([0.5, -0.0, 2.0]));
    for (x, value) in [(0, f32::NAN), (1, -1.0), (2, f32::INFINITY)] {
        image.put_pixel(x, 0, Rgb([0.25, value, 0.25]));
    }
    let folder = tempfile::tempdir().unwrap();
    let (images, warnings) = load(folder.path(), "exr", &encoded(image, ImageFormat::OpenExr));
    assert!(matches!(&warnings[..], [one] if one.contains("12 of 256 pixels")), "{warnings:?}");
    let green: Vec<f32> = images.image(2)[..4].iter().map(|rgb| rgb[1]).collect();
    assert_eq!(green, [0.0, 0.0, 65_504.0, 0.0]);
    assert!(images.image(2).iter().flatten().all(|value| value.is_sign_positive()), "no -0");
}
