//! Folders of images as databases distribute them, and as their users leave them.

use std::path::Path;

use image::{DynamicImage, ImageFormat, RgbImage};
use subsurf_encoder::capture::{Folder, Images, check_images, load_btf};

use super::Warnings;

/// Path of the image of a light and a view.
type Layout = fn([u16; 2], [u16; 2]) -> String;
/// What is done to a folder.
type Change<'a> = &'a dyn Fn(&Path);

/// θ and φ of lights and views.
const DIRECTIONS: [[u16; 2]; 3] = [[0, 0], [30, 90], [60, 270]];

/// An image of 3 × 2 pixels that is not like itself turned, by the number of its light and its view.
fn image(light: usize, view: usize) -> RgbImage {
    RgbImage::from_fn(3, 2, |x, y| {
        let value = |k: u32| u8::try_from(k).expect("small");
        image::Rgb([
            value(80 * x + 9),
            value(90 * y + 7),
            value(40 * u32::try_from(3 * light + view).expect("small") % 250),
        ])
    })
}

/// Writes images of all pairs, each where `name` says.
fn write(folder: &Path, name: impl Fn([u16; 2], [u16; 2]) -> String) {
    for (l, light) in DIRECTIONS.iter().enumerate() {
        for (v, view) in DIRECTIONS.iter().enumerate() {
            let path = folder.join(name(*light, *view));
            std::fs::create_dir_all(path.parent().expect("a folder")).unwrap();
            let image = DynamicImage::from(image(l, v));
            let is_linear = path.extension().is_some_and(|extension| extension == "exr");
            let image = if is_linear { DynamicImage::from(image.into_rgb32f()) } else { image };
            image.save(&path).unwrap();
        }
    }
}

fn plain([tl, pl]: [u16; 2], [tv, pv]: [u16; 2]) -> String {
    format!("tl{tl:03} pl{pl:03} tv{tv:03} pv{pv:03}.png")
}

/// Checks that a folder is read as all pairs, and says what it warns of.
fn read(folder: &Path, name: &str) -> Vec<String> {
    let warnings = Warnings::default();
    let images = load_btf(folder, &warnings).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert_eq!((images.lights().len(), images.views().len(), images.size()), (3, 3, [3, 2]), "{name}");
    for (l, v) in (0..3).flat_map(|l| (0..3).map(move |v| (l, v))) {
        let expected = DynamicImage::from(image(l, v)).into_rgb32f();
        let found = images.image(3 * l + v);
        let error = found.iter().flatten().zip(expected.as_raw()).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
        assert!(error < 1e-3, "{name}: light {l}, view {v}: {error}");
    }
    warnings.into_lines()
}

#[test]
fn folders_of_databases_are_read() {
    let place = tempfile::tempdir().unwrap();
    let layouts: [(&str, Layout); 7] = [
        ("flat", plain),
        ("by view", |l, v| format!("tv{:03}_pv{:03}/00000 {}", v[0], v[1], plain(l, v))),
        ("by material and view", |l, v| format!("WOOL/tv{:03}_pv{:03}/{}", v[0], v[1], plain(l, v))),
        ("view in the folder's name", |l, v| format!("tv{:03} pv{:03}/tl{:03} pl{:03}.png", v[0], v[1], l[0], l[1])),
        ("capitals and no zeros", |l, v| format!("TL{} PL{} TV{} PV{}.PNG", l[0], l[1], v[0], v[1])),
        ("wrapped", |l, v| format!("tl{} pl{} tv{} pv{}.png", l[0], 360 + l[1], v[0], i32::from(v[1]) - 360)),
        ("linear", |l, v| plain(l, v).replace("png", "exr")),
    ];
    for (name, layout) in layouts {
        let folder = place.path().join(name);
        write(&folder, layout);
        assert_eq!(read(&folder, name), Vec::<String>::new(), "{name}");
    }
}

/// What is not read is counted and named; what looks like an image but is the system's, or belongs to another set, is not
/// there.
#[test]
fn what_is_left_out_is_counted() {
    let place = tempfile::tempdir().unwrap();
    let copy = |folder: &Path, name: &str| {
        std::fs::create_dir_all(folder.join(name).parent().expect("a folder")).unwrap();
        std::fs::copy(folder.join(plain([30, 90], [60, 270])), folder.join(name)).unwrap();
    };
    for (names, expected) in [
        (&["tl095 pl000 tv000 pv000.png", "tl100 pl000 tv000 pv000.png"][..], "2 images are left out, as θ is not"),
        (&["tl030 pl000 tv-10 pv000.png"], "1 images are left out, as θ is not"),
        (&["tl022.5 pl000 tv000 pv000.png"], "whole degrees"),
        (&["tl030 pl450 tv060 pv270.png", "tl060 pl-90 tv030 pv090.png"], "2 images are left out, as 360° later"),
    ] {
        let folder = place.path().join("counted");
        write(&folder, plain);
        names.iter().for_each(|name| copy(&folder, name));
        let warnings = read(&folder, names[0]);
        assert!(warnings.len() == 1 && warnings[0].contains(expected), "{names:?}: {warnings:?}");
        assert!(warnings[0].contains(names[0]), "the first is named: {warnings:?}");
        std::fs::remove_dir_all(folder).unwrap();
    }
    let folder = place.path().join("others");
    write(&folder, plain);
    for name in ["._tl000 pl000 tv000 pv000.png", "preview.png", "small/tl000 pl000 tv000 pv000.png", "readme.txt"] {
        copy(&folder, name);
    }
    assert_eq!(read(&folder, "others"), Vec::<String>::new());
}

#[test]
fn what_is_wrong_with_a_folder_is_said_in_a_line() {
    let place = tempfile::tempdir().unwrap();
    let twice = |folder: &Path| {
        std::fs::copy(folder.join(plain([0, 0], [0, 0])), folder.join("0001 tl0 pl0 tv0 pv0.png")).unwrap();
    };
    let all_low = |folder: &Path| {
        std::fs::remove_dir_all(folder).unwrap();
        write(folder, |l, v| format!("tl{} pl{} tv{} pv{}.png", 91 + l[0], l[1], v[0], v[1]));
    };
    let cases: [(&str, Change<'_>); 5] = [
        ("the same directions as", &twice),
        ("9 images are left out, as θ is not from 0° to 90°", &all_low),
        ("no image that is named by its directions", &|folder| {
            std::fs::remove_dir_all(folder).unwrap();
            std::fs::create_dir(folder).unwrap();
        }),
        ("btf.json", &|folder| std::fs::write(folder.join("btf.json"), "{ \"simulated\"").unwrap()),
        ("an exposure that is none", &|folder| {
            std::fs::write(folder.join("btf.json"), "{ \"simulated\": { \"exposure\": 0 } }").unwrap();
        }),
    ];
    for (expected, change) in cases {
        let folder = place.path().join("wrong");
        write(&folder, plain);
        change(&folder);
        let message = Folder::open(&folder).unwrap_err().to_string();
        assert!(message.contains(expected) && message.lines().count() == 1, "{message}");
        std::fs::remove_dir_all(folder).unwrap();
    }
}

/// An image that is cut has its header still; it is found when images are read, of every format.
#[test]
fn one_image_that_is_cut_is_found() {
    let place = tempfile::tempdir().unwrap();
    let noise = |x: u32, y: u32| u8::try_from((x * 7919 + y * 104_729 + x * y * 31) % 251).expect("a byte");
    let picture = RgbImage::from_fn(32, 32, |x, y| image::Rgb([noise(x, y), noise(y, x), noise(x + y, x)]));
    for (extension, format) in [
        ("png", ImageFormat::Png),
        ("jpg", ImageFormat::Jpeg),
        ("tif", ImageFormat::Tiff),
        ("bmp", ImageFormat::Bmp),
        ("webp", ImageFormat::WebP),
        ("tga", ImageFormat::Tga),
        ("exr", ImageFormat::OpenExr),
    ] {
        let folder = place.path().join(extension);
        std::fs::create_dir(&folder).unwrap();
        let path = |light: u16| folder.join(plain([light, 0], [0, 0])).with_extension(extension);
        let image = DynamicImage::from(picture.clone());
        let image = if format == ImageFormat::OpenExr { DynamicImage::from(image.into_rgb32f()) } else { image };
        for light in [0, 30, 60] {
            image.save_with_format(path(light), format).unwrap();
        }
        let check = || check_images(&Folder::open(&folder)?, &());
        assert!(check().is_ok(), "{extension}: whole");
        let whole = std::fs::read(path(30)).unwrap();
        for part in [2, 3] {
            std::fs::write(path(30), &whole[..whole.len() * part / 4]).unwrap();
            let errors = [check().unwrap_err(), load_btf(&folder, &()).map(|_: Images| ()).unwrap_err()];
            for message in errors.map(|error| error.to_string()) {
                let is_named = message.contains(&format!("tl030 pl000 tv000 pv000.{extension}"));
                assert!(is_named && message.lines().count() == 1, "{extension}, {part} of 4: {message}");
            }
        }
    }
}
