//! Mutations of BTFs and BRDFs: none makes a reader panic.

use std::fs::OpenOptions;
use std::io::Cursor;
use std::path::Path;

use glam::Vec3;
use image::{DynamicImage, ImageFormat, RgbImage};
use subsurf_encoder::Error;
use subsurf_encoder::capture::{Merl, check_images, load_btf, open_btf};
use subsurf_tests::mutate::assert_survives;

use super::bsdf::BSDF;

/// A `.btf` file of UBO2014, one matrix: two lights, one view, two pixels, one component.
pub(super) fn btf() -> Vec<u8> {
    let word = |value: u32| value.to_le_bytes();
    let float = |value: f32| value.to_le_bytes();
    let facts: Vec<u8> = [&word(1)[..], &[b'x'; 240], &[0; 16]].concat();
    let mut file = b"!FMF06FC".to_vec();
    file.extend(word(u32::try_from(facts.len()).expect("small") + 4));
    file.extend(facts);
    // One view at (0.2, 0), two lights.
    file.extend([word(1), float(0.2), float(0.0), word(2), float(0.3), float(1.0), float(0.6), float(2.0)].concat());
    // 2 × 1 pixels; one component of floats, six rows of U and two of S V.
    file.extend([word(2), word(1), word(1)].concat());
    file.push(4);
    file.extend([word(1), word(6), word(2)].concat());
    file.extend((1..=9_u8).flat_map(|value| float(f32::from(value) / 8.0)));
    file
}

fn png() -> Vec<u8> {
    let image = RgbImage::from_fn(4, 3, |x, y| {
        image::Rgb([60 * x, 70 * y, 9].map(|value| u8::try_from(value).expect("small")))
    });
    let mut bytes = Cursor::new(Vec::new());
    DynamicImage::from(image).write_to(&mut bytes, ImageFormat::Png).expect("memory can be written to");
    bytes.into_inner()
}

fn load(path: &Path) -> Result<(), Error> {
    load_btf(path, &()).map(drop)
}

#[test]
fn mutations_of_files_are_survived() {
    assert_survives("some.btf", &[btf()], load);
    // Images of all pairs would be many; what a broken file gives is finite or refused, and this shows it.
    assert_survives("some.bsdf", &[BSDF.file()], |path| {
        let source = open_btf(path)?;
        let lights = source.lights().len();
        (0..60).try_for_each(|k| source.read(k * 97 % lights, k % source.views().len()).map(drop))
    });
}

/// Files of MERL have 35 MB. The beginning is mutated, and the length changes as that of the beginning does.
#[test]
fn mutations_of_tables_are_survived() {
    const LEN: u64 = 34_992_012;
    let mut beginning: Vec<u8> = [90_i32, 90, 180].iter().flat_map(|count| count.to_le_bytes()).collect();
    beginning.extend((0..500_u16).flat_map(|k| (f64::from(k) - 20.0).to_le_bytes()));
    let whole = beginning.len() as u64;
    assert_survives("some.binary", &[beginning], |path| {
        let file = OpenOptions::new().write(true).open(path).expect("the file was just written");
        let len = file.metadata().expect("it is there").len();
        file.set_len(LEN + len - whole).expect("holes take no room");
        let merl = Merl::open(path)?;
        for k in 0..200_u8 {
            let angle = f32::from(k);
            let light = Vec3::new(0.3 * angle.sin(), 0.3 * angle.cos(), 0.9).normalize();
            let found = merl.eval(light, Vec3::new(0.001 * angle, 0.0, 1.0).normalize());
            assert!(found.iter().all(|value| value.is_finite() && *value >= 0.0), "{found:?}");
        }
        Ok::<(), Error>(())
    });
}

#[test]
fn mutations_of_folders_are_survived() {
    let names = ["tl000 pl000 tv000 pv000.png", "tl030 pl090 tv000 pv000.png"];
    let views = ["tl000 pl000 tv060 pv270.png", "tl030 pl090 tv060 pv270.png"];
    // One image of four.
    assert_survives(names[0], &[png()], |path| {
        let folder = path.parent().expect("a folder");
        names.iter().skip(1).chain(&views).for_each(|name| std::fs::write(folder.join(name), png()).unwrap());
        check_images(open_btf(folder)?.as_ref(), &())
    });
    // Names of all.
    assert_survives("names.txt", &[[names, views].concat().join("\n").into_bytes()], |path| {
        let folder = path.with_extension("");
        std::fs::create_dir(&folder).expect("the folder is this attempt's own");
        let names = std::fs::read(path).expect("the file was just written");
        for name in String::from_utf8_lossy(&names).lines() {
            // Not all lines can be names.
            let _ = std::fs::write(folder.join(name.replace(['/', '\0'], "_")), png());
        }
        load(&folder)
    });
    // What is said of them.
    let facts = br#"{ "simulated": { "by": "a test", "exposure": 0.75, "seed": 3 } }"#;
    assert_survives("btf.json", &[facts.to_vec()], |path| {
        let folder = path.parent().expect("a folder");
        names.iter().chain(&views).for_each(|name| std::fs::write(folder.join(name), png()).unwrap());
        load(folder)
    });
}
