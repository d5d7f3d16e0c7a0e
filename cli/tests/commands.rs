//! The commands as their users call them.

mod common;

use std::process::Stdio;
use std::time::Duration;

use common::{assert_refused, command, files, finish, json, run, simulate, succeed};

#[test]
fn from_simulation_to_judgement() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let capture = simulate(folder, "a");
    let capture_bytes = std::fs::metadata(&capture).unwrap().len();
    let sidecar: serde_json::Value = serde_json::from_slice(&std::fs::read(folder.join("a.json")).unwrap()).unwrap();
    assert_eq!(sidecar["pitch_mm"], 0.5);
    assert_eq!(sidecar["simulated"]["source"]["scene"], "chessboard");

    for (method, bytes) in
        [("direct", 12 * 4 * 3 + 6 * 63 + 156), ("clusters", 12 * 4 * 3 + 63 + 132), ("song2009", 12 * 63 * 3 + 108)]
    {
        let report = json(folder, &format!("encode a.npy -M 4 --method {method} -o {method}.subsurf --json"));
        assert_eq!(report["bytes"], bytes, "{method}");
        assert_eq!(report["measured"], report["entries"], "{method}");
        assert!(report["seconds"].is_number() && report["peak_rss_bytes"].is_number(), "{method}: {report}");

        let judgement = json(folder, &format!("compare a.npy {method}.subsurf --json"));
        assert_eq!(judgement["bytes"], bytes, "{method}");
        assert_eq!(judgement["capture_bytes"], capture_bytes, "{method}");
        assert!(judgement["relative_error_mean"].as_f64().unwrap() < 0.05, "{method}: {judgement}");
        for light in ["uniform", "disc", "line"] {
            assert!(judgement["psnr_db"][light].as_f64().unwrap() > 25.0, "{method}, {light}: {judgement}");
            // Nine by seven pixels are less than the index's window.
            assert!(judgement["ssim"][light].is_null(), "{method}, {light}: {judgement}");
        }
        for key in ["relative_error_mean", "psnr_db", "ssim"] {
            assert_eq!(report[key], judgement[key], "{method}: encode and compare agree");
        }
    }
    succeed(folder, "compare a.npy direct.subsurf --images pictures");
    assert_eq!(files(&folder.join("pictures")), ["comparison.png", "disc.png", "line.png", "uniform.png"]);
    let sheet = image::open(folder.join("pictures/comparison.png")).unwrap();
    // Three by three pictures of 9 × 7 pixels, 28 times enlarged, with gaps of 6.
    assert_eq!((sheet.width(), sheet.height()), (3 * (9 * 28 + 6) + 6, 3 * (7 * 28 + 6) + 6));

    succeed(folder, "simulate --material jade --size 5x5 --window 5 --thickness 5 -o other.npy");
    assert_refused(&run(folder, "compare other.npy direct.subsurf"), &["5 × 5", "9 × 7", "not the same material"]);
}

#[test]
fn simulations_depend_on_their_seed_alone() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let args = "simulate --material marble --size 8 --window 5 --thickness 5 --noise 1e5 -o";
    let with = |threads: &str, name: &str, more: &str| {
        let mut command = command(folder);
        let words = args.split_whitespace().chain([name]).chain(more.split_whitespace());
        let run = finish(command.args(words).env("RAYON_NUM_THREADS", threads));
        assert_eq!(run.code, 0, "{}", run.err);
        std::fs::read(folder.join(name)).unwrap()
    };
    let one = with("1", "one.npy", "");
    assert_eq!(one, with("2", "two.npy", ""));
    assert_eq!(one, with("8", "eight.npy", ""));
    assert_ne!(one, with("2", "other.npy", "--seed 2"));
}

#[test]
fn images_drive_simulations() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Left half black, right half white.
    let picture = image::RgbImage::from_fn(16, 16, |x, _| image::Rgb([if x < 8 { 0 } else { 255 }; 3]));
    picture.save(folder.join("mask.png")).unwrap();
    let grey = image::RgbImage::from_pixel(16, 16, image::Rgb([188; 3]));
    grey.save(folder.join("grey.png")).unwrap();
    let small = "--size 6 --window 3 --thickness 5";

    succeed(folder, &format!("simulate --maps skin2=mask.png --maps marble=rest {small} -o mix.npy"));
    succeed(folder, "encode mix.npy -M 8");
    let report =
        succeed(folder, &format!("simulate --maps albedo=grey.png --maps mfp=1.5,1,0.6 {small} -o albedo.npy"));
    assert!(report.out.contains("synthetic capture"), "{}", report.out);
    succeed(folder, &format!("simulate --maps albedo=grey.png --maps mfp=mask.png:0.5:2 {small} -o map.npy"));

    let refused = |maps: &str, words: &[&str]| {
        assert_refused(&run(folder, &format!("simulate {maps} {small} -o no.npy")), words);
    };
    refused("--maps granite=rest", &["\"granite\"", "marble"]);
    refused("--maps marble=missing.png", &["missing.png", "an image"]);
    refused("--maps marble=mask.png", &["no material at pixel (0, 0)", "rest"]);
    refused("--maps marble=rest --maps skin1=rest", &["only one"]);
    refused("--maps albedo=grey.png", &["mfp"]);
    refused("--maps mfp=1", &["albedo"]);
    refused("--maps albedo=grey.png --maps mfp=far", &["mfp=far", "IMAGE:FROM:TO"]);
    refused("--maps albedo=grey.png --maps mfp=0", &["mean free path of 0 mm"]);
    refused("--maps marble", &["NAME=VALUE"]);
    assert_refused(&run(folder, "simulate --material onyx --window 4 -o no.npy"), &["--window is 4", "odd"]);
    assert_refused(&run(folder, "simulate --material onyx --pitch 0 -o no.npy"), &["--pitch is 0", "positive"]);
    assert!(!folder.join("no.npy").exists(), "nothing is written");
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

/// Images of two BTFs to one file, to targets, and back.
#[test]
fn btfs_from_images_to_judgement() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for sample in ["leather", "wood"] {
        succeed(folder, &format!("simulate btf {sample} --size 16 -o {sample}"));
    }
    let report = json(folder, "encode btf leather --p4 64 --mipmaps -o leather.subsurf --json");
    let file = std::fs::read(folder.join("leather.subsurf")).unwrap();
    assert_eq!(report["bytes"], file.len());
    assert_eq!(report["raw_bytes"], 3 * 16 * 16 * 6_561);

    let judgement = json(folder, "compare leather leather.subsurf --every 61 --json");
    for channel in ["y", "cr", "cb", "mean"] {
        assert_eq!(judgement["mssim"][channel], report["error"]["mssim"][channel], "encode and compare agree");
    }
    let mean = judgement["mssim"]["mean"].as_f64().unwrap();
    assert!(mean > 0.9, "{judgement}");
    succeed(folder, "compare leather leather.subsurf --every 500 --images pictures");
    assert_eq!(files(&folder.join("pictures")), ["comparison.png"]);
    let info = json(folder, "info leather.subsurf --json");
    assert_eq!((&info["materials"][0]["name"], &info["materials"][0]["levels"]), (&"leather".into(), &5.into()));
    assert_eq!(info["parts"][0]["entries"], 16 * 16 + 8 * 8 + 4 * 4 + 2 * 2 + 1);

    // Two materials share codebooks.
    let both = json(folder, "encode btf leather wood --p4 64 -o both.subsurf --json");
    assert_eq!(both["raw_bytes"], 2 * 3 * 16 * 16 * 6_561);
    let named = json(folder, "compare wood both.subsurf --every 61 --json");
    let numbered = json(folder, "compare wood both.subsurf --material 1 --every 61 --json");
    assert_eq!(named, numbered, "the folder's name is the material's");
    assert!(named["mssim"]["mean"].as_f64().unwrap() > 0.9, "{named}");
    assert_refused(&run(folder, "compare wood both.subsurf --material jade"), &["no material jade", "leather, wood"]);

    let small = json(folder, "encode btf leather --target-bytes 12kB -o small.subsurf --json");
    assert!((11_000..=12_000).contains(&small["bytes"].as_u64().unwrap()), "all that there may be, nearly: {small}");
    let alike = json(folder, "encode btf leather --target-ssim 0.99 -o alike.subsurf --json");
    let tried = |key: &str| -> Vec<f64> {
        alike["curve"].as_array().unwrap().iter().map(|point| point.pointer(key).unwrap().as_f64().unwrap()).collect()
    };
    let (bytes, quality) = (tried("/bytes"), tried("/error/mssim/mean"));
    assert!(bytes.is_sorted() && bytes.len() > 2, "a curve: {alike}");
    let smallest = bytes.iter().zip(&quality).find(|(_, quality)| **quality >= 0.99).unwrap();
    assert_eq!(alike["bytes"].as_f64().unwrap(), *smallest.0, "{alike}");
    assert_refused(&run(folder, "encode btf leather --target-bytes 1kB"), &["no file is that small"]);
    assert_refused(&run(folder, "encode btf leather --nodes 11,11"), &["--nodes has 2 numbers"]);

    // Factors are judged, and not drawn.
    let factored = json(folder, "encode btf wood --method factored -o factors.subsurf --json");
    let judgement = json(folder, "compare wood factors.subsurf --every 61 --json");
    assert_eq!(judgement["mssim"], factored["error"]["mssim"], "encode and compare agree");
    let of = |key: &str| judgement.pointer(key).and_then(serde_json::Value::as_f64).unwrap();
    assert!(of("/mssim/mean") > 0.95 && of("/psnr_db") > 35.0, "{judgement}");
    assert!(json(folder, "info factors.subsurf --json")["parts"]["expanded_bytes"].as_u64().unwrap() > 100_000);
    assert_refused(&run(folder, "render factors.subsurf -o factors.png"), &["factors", "--method nested"]);
    // The paper's encoder writes files as nested ones are.
    let paper = json(folder, "encode btf wood --method havran2010 -o paper.subsurf --json");
    assert!(paper["error"]["mssim"]["mean"].as_f64().unwrap() > 0.7, "{paper}");

    assert_refused(&run(folder, "encode btf nothing"), &["nothing", "a folder of images"]);
    draws_btfs(folder);
}

/// Pictures of the file beside the images, on devices and on the CPU; and what is refused.
fn draws_btfs(folder: &std::path::Path) {
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
        let args = "--mesh sphere --repeat 4,2 --samples 4 --size 80x60";
        let args =
            format!("render leather.subsurf {args} --images leather --backend {backend} -o {backend}.png --json");
        let report = json(folder, &args);
        // Each image is 16 × 16 pixels of four bytes.
        assert!(report["images_gpu_bytes"].as_u64().unwrap() >= 6_561 * 16 * 16 * 4, "{report}");
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

/// A driver that does not draw to half floats: the techniques that can do without draw the same, the other says why not.
#[test]
fn draws_without_half_floats_to_draw_to() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    let draw = |technique: &str, output: &str, has_halves: bool| {
        let args = format!(
            "render a.subsurf --mesh torus --extent 8 --size 60x50 --exposure 1 --backend gl --technique {technique} -o {output}"
        );
        let mut command = command(folder);
        if !has_halves {
            command.env("MESA_EXTENSION_OVERRIDE", "-GL_EXT_color_buffer_half_float -GL_EXT_color_buffer_float");
        }
        finish(command.args(args.split_whitespace()))
    };
    for technique in ["gather", "separable"] {
        for (output, has_halves) in [("halves.png", true), ("packed.png", false)] {
            let run = draw(technique, output, has_halves);
            assert_eq!(run.code, 0, "{technique}: {}", run.err);
        }
        let [a, b] = ["halves.png", "packed.png"].map(|file| image::open(folder.join(file)).unwrap().into_rgb8());
        let worst = a.iter().zip(b.iter()).map(|(a, b)| a.abs_diff(*b)).max();
        assert!(worst <= Some(2), "{technique}: {worst:?} of 255");
    }
    let run = draw("splat", "splat.png", false);
    assert!(run.code != 0 && run.err.contains("GL_EXT_color_buffer_half_float"), "{} {}", run.code, run.err);
}

#[test]
fn draws_on_everything_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    // A tetrahedron without normals or texture coordinates.
    std::fs::write(folder.join("t.obj"), "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n")
        .unwrap();
    std::fs::write(
        folder.join("t.ply"),
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty float s\n\
         property float t\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0\n1 0 0 1 0\n0 1 0 0 1\n3 0 1 2\n",
    )
    .unwrap();

    for backend in ["vulkan", "gl", "cpu"] {
        let flat =
            json(folder, &format!("render a.subsurf --light line --size 90x90 --backend {backend} -o f.png --json"));
        assert_eq!(flat["size"], serde_json::json!([90, 70]), "the patch keeps its shape");
        let picture = image::open(folder.join("f.png")).unwrap().into_rgb8();
        assert_eq!(picture.dimensions(), (90, 70));
        assert!(picture.get_pixel(45, 35)[0] > 100, "{backend}: lit in the middle");

        for mesh in ["t.obj", "t.ply"] {
            let args = format!(
                "render a.subsurf --mesh {mesh} --extent 4 --light 0,0,1 --view 0,0 --size 60x50 --backend {backend}"
            );
            let report = json(folder, &format!("{args} -o m.png --json"));
            let picture = image::open(folder.join("m.png")).unwrap().into_rgb8();
            assert_eq!(picture.dimensions(), (60, 50));
            let lit = picture.pixels().filter(|pixel| pixel[0] > 100).count();
            assert!(lit > 100, "{backend}, {mesh}: {lit} lit pixels, {report}");
        }
    }
    assert_refused(
        &run(folder, "render a.subsurf --mesh t.obj --mapping uv -o x.png"),
        &["no texture coordinates", "unwrap"],
    );
    assert_refused(&run(folder, "render a.subsurf --mesh a.npy -o x.png"), &["a.npy", ".obj"]);
    assert_refused(&run(folder, "render a.subsurf --light 0,0,1 -o x.png"), &["for meshes"]);
    assert_refused(&run(folder, "render a.subsurf --mesh t.obj --light disc -o x.png"), &["direction"]);
    assert_refused(&run(folder, "render a.npy -o x.png"), &["a.npy", "not a .subsurf file"]);
    let mut damaged = std::fs::read(folder.join("a.subsurf")).unwrap();
    damaged[200] ^= 1;
    std::fs::write(folder.join("damaged.subsurf"), damaged).unwrap();
    assert_refused(&run(folder, "render damaged.subsurf -o x.png"), &["damaged.subsurf", "PROF", "CRC-32"]);
    assert!(!folder.join("x.png").exists(), "nothing is drawn");
}

#[test]
fn without_a_driver_the_exit_code_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 4");
    let mut no_vulkan = command(folder);
    no_vulkan.env("VK_DRIVER_FILES", "/nowhere").env("VK_ICD_FILENAMES", "/nowhere");
    let refused = finish(no_vulkan.args(["render", "a.subsurf", "--backend", "vulkan", "-o", "x.png"]));
    assert_eq!(refused.code, 3, "{}", refused.err);
    assert!(refused.err.contains("no Vulkan device"), "{}", refused.err);
}

#[test]
fn an_interrupted_run_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let mut long = command(folder.path());
    long.args(["simulate", "--material", "onyx", "--size", "200", "-o", "a.npy"]).stderr(Stdio::null());
    let mut child = long.spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1_500));
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success(), "the run was still going");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(files(folder.path()), [""; 0], "no file, no half file");
}

#[test]
fn an_interrupted_fit_is_written() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    let mut long = command(folder);
    long.args(["encode", "a.npy", "--method", "yatagawa2020", "-K", "5", "-M", "200"]);
    let mut child = long.stdout(Stdio::piped()).stderr(Stdio::null()).spawn().unwrap();
    std::thread::sleep(Duration::from_millis(1_000));
    let kill = std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
    assert!(kill.success(), "the run was still going");
    let mut out = String::new();
    std::io::Read::read_to_string(&mut child.stdout.take().unwrap(), &mut out).unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(130), "{out}");
    assert!(out.contains("interrupted: this is the best model so far"), "{out}");
    succeed(folder, "compare a.npy a.subsurf");
}

#[test]
fn targets_choose_the_model() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    let report = json(folder, "encode a.npy --target-bytes 2kB --json");
    assert!(report["bytes"].as_u64().unwrap() <= 2_000, "{report}");
    assert!(!report["curve"].as_array().unwrap().is_empty(), "{report}");
    let told = succeed(folder, "encode a.npy --target-psnr 30");
    assert!(told.out.contains("rate-distortion curve"), "{}", told.out);
    assert_refused(&run(folder, "encode a.npy --target-psnr 300"), &["300 dB", "the best has"]);
    assert_refused(&run(folder, "encode a.npy --max-memory 1kB"), &["memory", "--max-memory allows 1.00 kB"]);
    assert_eq!(run(folder, "encode a.npy --target-psnr 30 -M 8").code, 2, "M is what is looked for");
    assert_refused(&run(folder, "encode a.npy --pitch 1 --threads 0"), &["--threads"]);
}
