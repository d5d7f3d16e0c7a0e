//! BTFs: simulated, encoded, judged, drawn. Images are simulated once for all tests: 12 × 12 pixels are the fewest that have a
//! structural similarity.

use std::path::{Path, PathBuf};
use std::sync::OnceLock;

use subsurf_scene::sphere;
use subsurf_tests::meshes::write_obj;

use crate::common::{assert_refused, files, json, run, succeed};

/// Pixels to a side of the images.
const SIDE: u64 = 12;

/// Folder with the images of leather and wood, and nothing else.
fn images() -> &'static Path {
    static IMAGES: OnceLock<PathBuf> = OnceLock::new();
    IMAGES.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("images");
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir(&folder).unwrap();
        for sample in ["leather", "wood"] {
            succeed(&folder, &format!("simulate btf {sample} --size {SIDE} -o {sample}"));
        }
        folder
    })
}

/// Leather in a file, with mipmaps, and what the command reports of it.
fn leather() -> &'static (PathBuf, serde_json::Value) {
    static LEATHER: OnceLock<(PathBuf, serde_json::Value)> = OnceLock::new();
    LEATHER.get_or_init(|| {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("leather.subsurf");
        let report = json(images(), &format!("encode btf leather --p4 64 --mipmaps -o {} --json", file.display()));
        (file, report)
    })
}

/// Leather and wood in one file, and what the command reports of it.
fn both() -> &'static (PathBuf, serde_json::Value) {
    static BOTH: OnceLock<(PathBuf, serde_json::Value)> = OnceLock::new();
    BOTH.get_or_init(|| {
        let file = Path::new(env!("CARGO_TARGET_TMPDIR")).join("both.subsurf");
        let report = json(images(), &format!("encode btf leather wood --p4 64 -o {} --json", file.display()));
        (file, report)
    })
}

/// A folder with an image for each pair of directions, which says that it is synthetic, or nothing at all.
#[test]
fn simulates_btfs() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    succeed(folder, "simulate btf leather --size 8 -o leather");
    let facts: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("leather/btf.json")).unwrap()).unwrap();
    assert_eq!(facts["simulated"]["sample"], "leather");
    assert_eq!(std::fs::read_dir(folder.join("leather")).unwrap().count(), 81 * 81 + 1);
    let picture = image::open(folder.join("leather/tl060 pl090 tv045 pv100.png")).unwrap().into_rgb8();
    assert_eq!(picture.dimensions(), (8, 8));
    assert!(picture.pixels().any(|pixel| pixel[0] > 20), "there is light");

    let info = json(folder, "info leather --json");
    assert_eq!(
        (&info["lights"], &info["views"], &info["raw_bytes"]),
        (&81.into(), &81.into(), &(3 * 64 * 6_561).into())
    );
    assert!(succeed(folder, "info leather").out.contains("synthetic"));
    std::fs::remove_file(folder.join("leather/tl060 pl090 tv045 pv100.png")).unwrap();
    assert_refused(&run(folder, "info leather"), &["1 of 81 × 81 images are missing", "tl060 pl090 tv045 pv100"]);

    succeed(folder, "simulate btf wood --size 8 --hdr -o wood");
    let picture = image::open(folder.join("wood/tl000 pl000 tv000 pv000.exr")).unwrap();
    assert_eq!(picture.color(), image::ColorType::Rgb32F);

    assert_refused(&run(folder, "simulate btf wood --size 8 -o wood"), &["wood", "is there already"]);
    assert_refused(&run(folder, "simulate btf wood --size 4 -o small"), &["--size is 4", "8 to 1024"]);
    assert_refused(&run(folder, "simulate btf wood --exposure 0 -o dark"), &["--exposure is 0", "positive"]);
    assert_eq!(files(folder), ["leather", "wood"], "nothing is left of what was refused");
}

/// A BRDF of MERL is a BTF of one texel.
#[test]
fn brdfs_are_encoded_and_judged() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Red paint without gloss, in their units.
    let mut file: Vec<u8> = [90_i32, 90, 180].iter().flat_map(|count| count.to_le_bytes()).collect();
    for (albedo, unit) in [(0.6, 1.0), (0.2, 1.15), (0.1, 1.66)] {
        let value: f64 = albedo / std::f64::consts::PI * 1500.0 / unit;
        file.extend(value.to_le_bytes().repeat(90 * 90 * 180));
    }
    std::fs::write(folder.join("paint.binary"), file).unwrap();
    let report = json(folder, "encode btf paint.binary --p4 1 -o paint.subsurf --json");
    let judgement = json(folder, "compare paint.binary paint.subsurf --json");
    assert!(report["error"]["mssim"].is_null() && judgement["mssim"].is_null(), "one texel: {judgement}");
    assert!(judgement["psnr_db"].as_f64().unwrap() > 35.0, "{judgement}");
    let told = succeed(folder, "compare paint.binary paint.subsurf --every 61");
    assert!(told.out.contains("smaller than 11 × 11"), "{}", told.out);
    assert_refused(&run(folder, "encode btf paint.binary --target-ssim 0.9"), &["11 × 11 pixels", "give sizes"]);
}

#[test]
fn a_btf_from_images_to_judgement() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (file, report) = leather();
    let (images, file) = (images().join("leather"), file.display());
    let images = images.display();
    assert_eq!(report["bytes"], std::fs::metadata(file.to_string()).unwrap().len());
    assert_eq!(report["raw_bytes"], 3 * SIDE * SIDE * 6_561);

    let judgement = json(folder, &format!("compare {images} {file} --every 61 --json"));
    for channel in ["y", "cr", "cb", "mean"] {
        assert_eq!(judgement["mssim"][channel], report["error"]["mssim"][channel], "encode and compare agree");
    }
    let mean = judgement["mssim"]["mean"].as_f64().unwrap();
    assert!(mean > 0.9, "{judgement}");
    succeed(folder, &format!("compare {images} {file} --every 500 --images pictures"));
    assert_eq!(files(&folder.join("pictures")), ["comparison.png"]);
    let info = json(folder, &format!("info {file} --json"));
    assert_eq!((&info["materials"][0]["name"], &info["materials"][0]["levels"]), (&"leather".into(), &4.into()));
    assert_eq!(info["parts"][0]["entries"], 12 * 12 + 6 * 6 + 3 * 3 + 1);
    assert_refused(&run(folder, "encode btf nothing"), &["nothing", "a folder of images"]);
}

#[test]
fn two_materials_share_codebooks() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (file, report) = both();
    let (images, file) = (images().join("wood"), file.display());
    let images = images.display();
    assert_eq!(report["raw_bytes"], 2 * 3 * SIDE * SIDE * 6_561);
    let named = json(folder, &format!("compare {images} {file} --every 61 --json"));
    let numbered = json(folder, &format!("compare {images} {file} --material 1 --every 61 --json"));
    assert_eq!(named, numbered, "the folder's name is the material's");
    assert!(named["mssim"]["mean"].as_f64().unwrap() > 0.9, "{named}");
    let refused = run(folder, &format!("compare {images} {file} --material jade"));
    assert_refused(&refused, &["no material jade", "leather, wood"]);
}

#[test]
fn the_best_btf_of_a_size() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let images = images().join("leather");
    let images = images.display();
    let small = json(folder, &format!("encode btf {images} --target-bytes 12kB -o small.subsurf --json"));
    assert!((11_000..=12_000).contains(&small["bytes"].as_u64().unwrap()), "all that there may be, nearly: {small}");
    assert_refused(&run(folder, &format!("encode btf {images} --nodes 11,11")), &["--nodes has 2 numbers"]);
}

#[test]
fn the_smallest_btf_of_a_quality() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let images = images().join("leather");
    let images = images.display();
    let alike = json(folder, &format!("encode btf {images} --target-ssim 0.99 -o alike.subsurf --json"));
    let tried = |key: &str| -> Vec<f64> {
        alike["curve"].as_array().unwrap().iter().map(|point| point.pointer(key).unwrap().as_f64().unwrap()).collect()
    };
    let (bytes, quality) = (tried("/bytes"), tried("/error/mssim/mean"));
    assert!(bytes.is_sorted() && bytes.len() > 2, "a curve: {alike}");
    let smallest = bytes.iter().zip(&quality).find(|(_, quality)| **quality >= 0.99).unwrap();
    assert_eq!(alike["bytes"].as_f64().unwrap(), *smallest.0, "{alike}");
}

#[test]
fn no_btf_is_that_small() {
    let folder = tempfile::tempdir().unwrap();
    let images = images().join("leather");
    let refused = run(folder.path(), &format!("encode btf {} --target-bytes 1kB -o a.subsurf", images.display()));
    assert_refused(&refused, &["no file is that small"]);
}

/// They are judged, and not drawn.
#[test]
fn btfs_in_factors() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let images = images().join("wood");
    let images = images.display();
    let factored = json(folder, &format!("encode btf {images} --method factored -o factors.subsurf --json"));
    let judgement = json(folder, &format!("compare {images} factors.subsurf --every 61 --json"));
    assert_eq!(judgement["mssim"], factored["error"]["mssim"], "encode and compare agree");
    let of = |key: &str| judgement.pointer(key).and_then(serde_json::Value::as_f64).unwrap();
    assert!(of("/mssim/mean") > 0.95 && of("/psnr_db") > 35.0, "{judgement}");
    assert!(json(folder, "info factors.subsurf --json")["parts"]["expanded_bytes"].as_u64().unwrap() > 100_000);
    assert_refused(&run(folder, "render factors.subsurf -o factors.png"), &["factors", "--method nested"]);
}

/// It writes files as those of nested codebooks are.
#[test]
fn btfs_by_the_encoder_of_the_paper() {
    let folder = tempfile::tempdir().unwrap();
    let images = images().join("wood");
    let paper =
        json(folder.path(), &format!("encode btf {} --method havran2010 -o paper.subsurf --json", images.display()));
    assert!(paper["error"]["mssim"]["mean"].as_f64().unwrap() > 0.7, "{paper}");
}

/// Pictures of the file beside the images, on devices and on the CPU; and what is refused.
#[test]
fn draws_btfs() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::copy(&leather().0, folder.join("leather.subsurf")).unwrap();
    std::fs::copy(&both().0, folder.join("both.subsurf")).unwrap();
    write_obj(&folder.join("sphere.obj"), &sphere(20.0, 16));
    let images = images().join("leather");
    let images = images.display();
    let halves = |name: &str| {
        let sheet = image::open(folder.join(name)).unwrap().into_rgb8();
        assert_eq!(sheet.dimensions(), (6 + 80 + 6 + 80 + 6, 6 + 60 + 6), "two pictures with gaps");
        let half = |left: u32| {
            let places = (6..66).flat_map(move |y| (left..left + 80).map(move |x| (x, y)));
            places.map(|(x, y)| sheet.get_pixel(x, y).0).collect::<Vec<_>>()
        };
        (half(6), half(92))
    };
    for backend in ["vulkan", "gl"] {
        let args = "--mesh sphere.obj --repeat 4,2 --samples 4 --size 80x60";
        let args =
            format!("render leather.subsurf {args} --images {images} --backend {backend} -o {backend}.png --json");
        let report = json(folder, &args);
        // Each image has pixels of four bytes.
        assert!(report["images_gpu_bytes"].as_u64().unwrap() >= 6_561 * SIDE * SIDE * 4, "{report}");
        assert!(report["gpu_bytes"].as_u64().unwrap() < 40_000, "{report}");
        let (file, images) = halves(&format!("{backend}.png"));
        let light = |picture: &[[u8; 3]]| picture.iter().flatten().map(|c| f64::from(*c)).sum::<f64>();
        let ratio = light(&file) / light(&images);
        assert!((0.95..1.05).contains(&ratio), "{backend}: the file is {ratio} times as bright as its images");
        assert!(file.iter().any(|pixel| pixel[0] > 2 * pixel[2]), "{backend}: leather is brown");
    }
    let report = json(folder, "render leather.subsurf --mesh torus --size 80x60 --backend cpu -o cpu.png --json");
    assert!(report["exposure"].as_f64().unwrap() > 0.0 && report["repeat"][0].as_f64().unwrap() > 1.0, "{report}");
    succeed(
        folder,
        "render both.subsurf --material wood --mesh torus --size 80x60 --samples 0 --backend gl -o wood.png",
    );

    std::fs::write(folder.join("bare.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").unwrap();
    for (args, words) in [
        ("render leather.subsurf --mesh bare.obj", ["texture coordinates", "UV"]),
        ("render leather.subsurf --technique splat", ["--technique", "this file is a BTF"]),
        ("render leather.subsurf --samples 5000", ["--samples is 5000", "1024"]),
        ("render both.subsurf --material jade", ["--material jade", "leather, wood"]),
        ("render leather.subsurf --images nothing --size 40", ["nothing", "a folder of images"]),
        ("render leather.subsurf --light disc", ["direction", "patches"]),
    ] {
        assert_refused(&run(folder, &format!("{args} -o r.png")), &words);
    }
    assert!(!folder.join("r.png").exists(), "nothing is written");
}
