//! Inputs and requests that ask for too much, or are not quite what they seem: said in one line, or done and said.

use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use image::ImageFormat;

use crate::common::{assert_refused, command, files, finish, run, simulate, succeed};

/// A tiny capture and its file, `a.npy` and `a.subsurf`.
fn material(folder: &Path) {
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 2");
}

#[test]
fn pictures_have_the_format_of_their_names() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    material(folder);
    for (name, format) in [
        ("a.png", ImageFormat::Png),
        ("none", ImageFormat::Png),
        ("a.jpg", ImageFormat::Jpeg),
        ("a.JPEG", ImageFormat::Jpeg),
        ("a.tif", ImageFormat::Tiff),
        ("a.webp", ImageFormat::WebP),
        ("a.bmp", ImageFormat::Bmp),
    ] {
        succeed(folder, &format!("render a.subsurf --backend cpu --size 36x28 -o {name}"));
        let bytes = std::fs::read(folder.join(name)).unwrap();
        assert_eq!(image::guess_format(&bytes).ok(), Some(format), "{name}");
        assert_eq!(image::load_from_memory(&bytes).unwrap().width(), 36, "{name}");
    }
    for name in ["a.gif", "a.exr", "a.subsurf"] {
        let refused = run(folder, &format!("render a.subsurf --backend cpu -o {name}"));
        assert_refused(&refused, &[name, "pictures are written as .png, .jpg"]);
    }
}

#[test]
fn maps_say_what_is_changed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let mut map = image::Rgb32FImage::from_pixel(8, 8, image::Rgb([0.5, 0.25, 0.75]));
    map.save(folder.join("albedo.exr")).unwrap();
    let small = "--maps mfp=1.5 --size 4 --window 3 --thickness 5";
    let told = succeed(folder, &format!("simulate --maps albedo=albedo.exr {small} -o exr.npy"));
    assert_eq!(told.err, "", "nothing is changed");
    // sRGB of the same values, nearly.
    image::RgbImage::from_pixel(8, 8, image::Rgb([188, 137, 225])).save(folder.join("albedo.png")).unwrap();
    succeed(folder, &format!("simulate --maps albedo=albedo.png {small} -o png.npy"));
    let [exr, png] = ["exr.npy", "png.npy"].map(|name| {
        let bytes = std::fs::read(folder.join(name)).unwrap();
        let values = bytes[bytes.len() - 4 * 4 * 4 * 27..].as_chunks().0.iter().map(|value| f32::from_le_bytes(*value));
        values.filter(|rd| rd.is_finite()).sum::<f32>()
    });
    assert!((exr / png - 1.0).abs() < 0.01, "{exr} is not {png}");

    map.put_pixel(1, 2, image::Rgb([f32::NAN, 0.5, 0.5]));
    map.put_pixel(3, 2, image::Rgb([1.5, -0.5, 0.5]));
    map.save(folder.join("odd.exr")).unwrap();
    let told = succeed(folder, &format!("simulate --maps albedo=odd.exr {small} -o odd.npy"));
    assert_eq!(told.err.lines().count(), 1, "{}", told.err);
    assert!(told.err.contains("warning: odd.exr: 2 of 64 pixels have values that are not 0 to 1"), "{}", told.err);

    material(folder);
    let told = succeed(folder, "render a.subsurf --mesh sphere --environment odd.exr --size 16 --backend cpu -o o.png");
    assert!(told.err.contains("odd.exr: 2 of 64 pixels are negative, infinite or NaN"), "{}", told.err);

    std::fs::write(folder.join("package.json"), r#"{"name": "unrelated"}"#).unwrap();
    let refused = run(folder, &format!("simulate --maps albedo=albedo.exr {small} -o package.npy"));
    assert_refused(&refused, &["package.json: is there and is no sidecar", "choose another"]);
}

#[test]
fn what_would_take_too_much_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (args, words) in [
        ("simulate --material onyx --size 1000000000 -o no.npy", ["--size", "65535"]),
        ("simulate --material onyx --size 65535 --window 2047 -o no.npy", ["--size 65535x65535", "takes"]),
        ("simulate --material onyx --thickness 1e9 -o no.npy", ["--thickness is 1000000000 mm", "10000 mm"]),
        ("simulate --maps albedo=no.png --maps mfp=1 --eta 1e9 -o no.npy", ["--eta is 1000000000", "1 to 4"]),
        ("encode no.npy --threads 100000", ["--threads is 100000", "threads make sense"]),
        ("encode btf no --threads 100000", ["--threads is 100000", "threads make sense"]),
    ] {
        assert_refused(&run(folder, args), &words);
    }
    let many = finish(command(folder).args(["encode", "no.npy"]).env("RAYON_NUM_THREADS", "100000"));
    assert_refused(&many, &["RAYON_NUM_THREADS is 100000"]);
    assert_eq!(files(folder), [""; 0], "nothing is written");
    material(folder);
    // What never ends is no material.
    if Path::new("/dev/zero").exists() {
        assert_refused(&run(folder, "info /dev/zero"), &["/dev/zero"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn memory_that_is_not_there_is_foreseen() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    material(folder);
    let limited = |args: &str| {
        let mut shell = std::process::Command::new("sh");
        let line = format!("ulimit -v 3000000; exec {} {args}", env!("CARGO_BIN_EXE_subsurf"));
        finish(shell.args(["-c", &line]).current_dir(folder).env("RAYON_NUM_THREADS", "2"))
    };
    let picture = limited("render a.subsurf --backend cpu --size 16000x16000 -o a.png");
    assert_refused(&picture, &["16000 × 16000 pixels takes", "of memory, and there is"]);
    // A small file of a large picture.
    image::GrayImage::new(12_000, 12_000).save(folder.join("large.png")).unwrap();
    let map = limited("simulate --maps marble=large.png --size 4 --window 3 -o b.npy");
    assert_refused(&map, &["large.png: a picture of 12000 × 12000 pixels takes", "of memory, and there is"]);
    let names = |pair: u32| format!("tl{:03} pl000 tv{:03} pv000.png", 20 * (pair / 2), 20 * (pair % 2));
    std::fs::create_dir(folder.join("btf")).unwrap();
    for pair in 0..4 {
        image::GrayImage::from_fn(4, 4, |x, y| image::Luma([u8::try_from(40 * pair + 9 * x + y).unwrap()]))
            .save(folder.join("btf").join(names(pair)))
            .unwrap();
    }
    let fit = limited("encode btf btf --nodes 64,64,64,64");
    assert_refused(&fit, &["16 texels with --nodes 64,64,64,64 and --p4 512 takes", "of memory, and there is"]);
    let images = limited("simulate btf leather --size 1024 -o leather");
    assert_refused(&images, &["--size 1024 takes", "of memory, and there is"]);
    assert_eq!(limited("render a.subsurf --backend cpu --size 90x70 -o a.png").code, 0, "a small one can be had");
}

/// Writes a capture whose fits take minutes, and tenths of a second to end early: 96 × 96 pixels, windows of 11.
#[cfg(unix)]
fn large(folder: &Path) {
    let (side, window) = (96, 11);
    let shape = format!("({side}, {side}, {window}, {window}, 3)");
    let header = format!("{{'descr': '<f4', 'fortran_order': False, 'shape': {shape}, }}\n");
    let length = u16::try_from(header.len()).unwrap().to_le_bytes();
    let value = |k: usize| 0.1_f32 / (1 + k * 7_919 % 101) as f32;
    let values = (0..side * side * window * window * 3).flat_map(|k| value(k).to_le_bytes());
    let file: Vec<u8> =
        b"\x93NUMPY\x01\x00".iter().copied().chain(length).chain(header.bytes()).chain(values).collect();
    std::fs::write(folder.join("a.npy"), file).unwrap();
    std::fs::write(folder.join("a.json"), r#"{"pitch_mm": 0.5}"#).unwrap();
}

/// Starts a fit that takes minutes, sends it signals, and waits for its end.
#[cfg(unix)]
fn signalled(folder: &Path, signals: &[&str]) -> (Option<i32>, Duration) {
    let mut long = command(folder);
    long.args(["encode", "a.npy", "--method", "yatagawa2020", "-K", "5", "-M", "250", "-o", "long.subsurf"]);
    let mut child = long.stdout(Stdio::null()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(700));
    let mut start = Instant::now();
    for signal in signals {
        start = Instant::now();
        let kill = std::process::Command::new("kill").args([*signal, &child.id().to_string()]).status().unwrap();
        assert!(kill.success(), "the run was still going");
        std::thread::sleep(Duration::from_millis(20));
    }
    (child.wait().unwrap().code(), start.elapsed())
}

#[cfg(unix)]
#[test]
fn a_second_interruption_or_a_termination_ends_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    large(folder);
    for signals in [&["-TERM"][..], &["-HUP"], &["-INT", "-INT"], &["-INT", "-TERM"]] {
        let (code, took) = signalled(folder, signals);
        assert_eq!(code, Some(130), "{signals:?}");
        assert!(took < Duration::from_secs(1), "{signals:?}: {took:?}");
        assert_eq!(files(folder), ["a.json", "a.npy"], "{signals:?}: no file, no half file");
    }
}

#[test]
fn no_device_is_a_code_of_its_own() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    material(folder);
    let without = |args: &str| {
        let mut bare = command(folder);
        bare.args(args.split_whitespace());
        for (key, value) in [
            ("VK_DRIVER_FILES", "/nowhere"),
            ("VK_ICD_FILENAMES", "/nowhere"),
            ("__EGL_VENDOR_LIBRARY_FILENAMES", "/nowhere"),
        ] {
            bare.env(key, value);
        }
        finish(&mut bare)
    };
    for technique in ["splat", "separable"] {
        let none = without(&format!("render a.subsurf --mesh sphere --technique {technique} --size 16 -o a.png"));
        assert_eq!((none.code, none.err.lines().count()), (3, 1), "{technique}: {}", none.err);
        assert!(none.err.contains("--technique gather") && none.err.contains("no device"), "{}", none.err);
    }
    assert_eq!(without("render a.subsurf --mesh sphere --size 16 -o a.png").code, 0, "the CPU draws");
    let cpu = run(folder, "render a.subsurf --mesh sphere --technique splat --backend cpu -o a.png");
    assert_refused(&cpu, &["--technique gather", "--backend"]);
}
