//! Captures: simulated, encoded, judged.

use crate::common::{assert_refused, command, files, finish, json, run, simulate, succeed};

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
        let report =
            json(folder, &format!("encode a.npy -M 4 --no-basis --method {method} -o {method}.subsurf --json"));
        assert_eq!(report["bytes"], bytes, "{method}");
        assert!(report["basis"].is_null(), "{method}");
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

/// L maps and A Gaussians take 4 + 4 A + 6 A L (L + 1) + 12 L S bytes, 24 in the section table, and fill before them.
#[test]
fn files_get_a_separable_basis() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    simulate(folder, "a");
    let plain = json(folder, "encode a.npy -M 4 --no-basis -o plain.subsurf --json")["bytes"].as_u64().unwrap();
    let size = |basis: &serde_json::Value| {
        let [l, a] = ["terms", "gaussians"].map(|key| basis[key].as_u64().unwrap());
        assert_eq!(basis["sigmas_px"].as_array().unwrap().len() as u64, a, "{basis}");
        // S is R + 1.
        4 + 4 * a + 6 * a * l * (l + 1) + 12 * l * 3 + 24
    };
    let report = json(folder, "encode a.npy -M 4 -o whole.subsurf --json");
    let bytes = report["bytes"].as_u64().unwrap();
    assert!((0..4).contains(&(bytes - plain - size(&report["basis"]))), "{report}");
    let info = json(folder, "info whole.subsurf --json");
    assert_eq!(info["basis"], report["basis"]);
    assert!(json(folder, "info plain.subsurf --json")["basis"].is_null(), "there is none");

    // The same section, whether it comes with the file or is added to it; another target, another basis.
    std::fs::copy(folder.join("plain.subsurf"), folder.join("added.subsurf")).unwrap();
    succeed(folder, "encode --add-basis added.subsurf");
    let read = |name: &str| std::fs::read(folder.join(name)).unwrap();
    assert!(read("added.subsurf") == read("whole.subsurf"), "the same bytes");
    let told = json(folder, "encode --add-basis whole.subsurf --basis-psnr 10 -o small.subsurf --json");
    assert_eq!((&told["basis"]["terms"], &told["basis"]["gaussians"]), (&1.into(), &2.into()));

    assert_refused(&run(folder, "render plain.subsurf --technique separable -o a.png"), &["--add-basis", "splat"]);
    assert_refused(&run(folder, "encode a.npy --target-bytes 200"), &["200", "--no-basis"]);
    assert_refused(&run(folder, "encode a.npy --target-bytes 300"), &["smallest takes", "are kept", "--no-basis"]);
    assert_refused(&run(folder, "encode --add-basis missing.subsurf"), &["missing.subsurf"]);
    assert_refused(&run(folder, "encode --add-basis a.npy"), &["a.npy"]);
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

#[test]
fn profiles_are_traced_photon_by_photon() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let layers = "--layer a=0.5,s=9,g=0.8,eta=1.4,d=0.3 --layer a=0.1/0.4/0.9,s=2";
    for threads in [1, 2] {
        let profile = format!("simulate profile {layers} --photons 500 -o {threads}.csv --threads {threads}");
        let said = succeed(folder, &profile).out;
        assert!(said.contains("1500 photon packets"), "{said}");
    }
    let [one, two] = ["1.csv", "2.csv"].map(|name| std::fs::read_to_string(folder.join(name)).unwrap());
    assert_eq!(one, two, "files do not hang on the number of threads");
    assert!(one.lines().any(|line| line == "r_mm,rd_red,rd_green,rd_blue,error_red,error_green,error_blue"), "{one}");

    let refused = |args: &str, says: &[&str]| assert_refused(&run(folder, args), says);
    refused("simulate profile --layer s=2 -o x.csv", &["--layer s=2", "a="]);
    refused("simulate profile --layer a=1,s=2,h=3 -o x.csv", &["h=3 is none of a=, s=, g=, eta= and d="]);
    refused(
        "simulate profile --layer a=1,s=2 --layer a=1,s=2 -o x.csv",
        &["layer 1: thickness", "finite above other layers"],
    );

    let mci = |output: &str| format!("1.0\n1\n{output} A\n500\n0.01 0.01\n4 5 1\n1\n1.0\n1.4 1 100 0.9 0.1\n1.0\n");
    std::fs::write(folder.join("a.mci"), mci("a.mco")).unwrap();
    succeed(folder, "simulate mcml a.mci -o results");
    let results = std::fs::read_to_string(folder.join("results/a.mco")).unwrap();
    assert!(results.starts_with("A1 ") && results.contains("\nRd_r #[1/cm2]"), "{results}");
    std::fs::write(folder.join("b.mci"), mci("../b.mco")).unwrap();
    refused("simulate mcml b.mci", &["../b.mco", "not a plain file name"]);
    std::fs::write(folder.join("c.mci"), mci("c.mci")).unwrap();
    refused("simulate mcml c.mci", &["c.mci", "the input"]);
}

#[test]
fn kernels_are_made_of_profiles() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let told = succeed(folder, "kernel --material skin1 -o skin.subsurf").out;
    assert!(told.contains("skin.subsurf: pre-integrated, 2 convolutions of 25 taps"), "{told}");
    assert!(told.contains("errors: Frobenius 0.") && told.contains("edge 0.0 %"), "{told}");
    let told = succeed(folder, "kernel --material skin1 --method svd --terms 2 --taps 9 --compare -o svd.subsurf").out;
    assert!(told.contains("svd, 4 convolutions of 9 taps"), "{told}");
    assert_eq!(told.lines().filter(|line| line.starts_with("gaussians ")).count(), 6, "{told}");
    for threads in [1, 2] {
        succeed(folder, &format!("kernel --material marble --method guided --threads {threads} -o {threads}.subsurf"));
    }
    let [one, two] = ["1.subsurf", "2.subsurf"].map(|name| std::fs::read(folder.join(name)).unwrap());
    assert_eq!(one, two, "files do not hang on the number of threads");
    let told = succeed(folder, "kernel --near 0.05/0.03/0.02 --far 1.2/0.4/0.2 --weight 0.5 -o two.subsurf").out;
    assert!(
        told.contains("two-gaussians")
            && told.contains("--far 1.2/0.4/0.2 --weight 0.5/0.5/0.5 --reflectance 1/1/1 --eta 1.3"),
        "{told}"
    );
    succeed(folder, "kernel --material skin2 --model dipole --reflectance 0.5 -o dipole.subsurf");

    // Profiles of other programs, and of base materials.
    std::fs::write(folder.join("grey.csv"), "r;rd\n0,5;0,2\n1,5;0,02\n").unwrap();
    succeed(folder, "kernel grey.csv -o grey.subsurf");
    succeed(folder, "kernel grey.csv grey.csv grey.csv -o three.subsurf");
    simulate(folder, "a");
    succeed(folder, "encode a.npy -M 2 -o a.subsurf");
    succeed(folder, "kernel a.subsurf --base 1 --reflectance 0.7 -o base.subsurf");

    let refused = |args: &str, says: &[&str]| assert_refused(&run(folder, args), says);
    refused("kernel a.subsurf -o no.subsurf", &["which of its 2 base materials", "--base"]);
    refused("kernel a.subsurf --base 2 -o no.subsurf", &["a.subsurf", "no base material 2", "2, from 0"]);
    refused("kernel two.subsurf -o no.subsurf", &["two.subsurf", "expected a BSSRDF"]);
    refused("kernel grey.csv --base 0 -o no.subsurf", &["--base is for a .subsurf file"]);
    refused("kernel grey.csv grey.csv -o no.subsurf", &["two files"]);
    refused("kernel grey.csv -o grey.csv", &["grey.csv", "is the input"]);
    refused("kernel nowhere.csv -o no.subsurf", &["nowhere.csv"]);
    refused("kernel --material skin1 --guide 2 -o no.subsurf", &["--guide is for --method guided"]);
    refused("kernel --material skin1 --taps 4 -o no.subsurf", &["4 taps", "odd"]);
    refused("kernel --near 1 --far 0.5 --weight 0.5 -o no.subsurf", &["near Gaussian of 1", "narrower"]);
    refused("kernel grey.csv --model burley -o no.subsurf", &["--model and --photons are for --material"]);
    refused("kernel grey.csv --photons 3 -o no.subsurf", &["--model and --photons are for --material"]);
    refused(
        "kernel grey.csv --method two-gaussians --weight 1 --far 2 -o no.subsurf",
        &["all of --near, --far and --weight"],
    );
    refused(
        "kernel --material marble --model dipole --photons 5 -o no.subsurf",
        &["--photons: the dipole is a formula"],
    );
    refused("kernel --material skin1 --method svd --terms 99 --compare", &["99 terms"]);
    refused("kernel a.subsurf a.subsurf a.subsurf -o no.subsurf", &["a .subsurf file has all channels"]);
    refused("kernel --near x --far 0.5 --weight 0.5 -o no.subsurf", &["--near is x", "red/green/blue"]);
    refused("kernel grey.csv --reflectance 2 -o no.subsurf", &["--reflectance is 2"]);
    refused("kernel --material spectralon -o no.subsurf", &["spectralon does not absorb"]);
    assert!(!folder.join("no.subsurf").exists(), "nothing is written");
}
