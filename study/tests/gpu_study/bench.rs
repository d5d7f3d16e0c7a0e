//! Benchmarks, as short as can be.

use std::path::Path;
use std::process::Stdio;
use std::time::Duration;

use crate::common::{assert_refused, command, files, json, run, succeed};
use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis};
use subsurf_encoder::capture::{FolderWriter, Pixels};
use subsurf_encoder::simulate::relief::{Sample, simulate};
use subsurf_encoder::synthetic::{NestedShape, Shape};
use subsurf_tests::drawable;

/// The images of a BTF are as many bytes as they have pixels.
#[test]
fn loading_of_a_btf_is_timed_beside_its_images() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let writer = FolderWriter::new(&folder.join("leather"), 16, Pixels::Display { exposure: 1.0 }).unwrap();
    simulate(Sample::Leather, 16, 1, |light, view, image| writer.write(light, view, image), &()).unwrap();
    writer.finish(&serde_json::json!({})).unwrap();
    let file = NestedShape::small().database(2).to_bytes();
    std::fs::write(folder.join("leather.subsurf"), &file).unwrap();
    let load = json(folder, "bench load --btf leather.subsurf --images leather --runs 2 --dir . --json");
    assert_eq!(load["storage"]["images"]["bytes"], 3 * 16 * 16 * 6_561);
    assert_eq!(load["storage"]["file"]["bytes"], file.len());
    assert!(load["images_over_file"]["load_warm"].as_f64().unwrap() > 0.0, "{load}");
}

#[test]
fn an_interrupted_benchmark_takes_its_files_along() {
    let folder = tempfile::tempdir().unwrap();
    let mut long = command(folder.path());
    long.args(["bench", "load", "--case", "150x150,25,8,13", "--dir", ".", "--backend", "cpu"]).stdout(Stdio::null());
    let mut child = long.stderr(Stdio::null()).spawn().unwrap();
    while files(folder.path()).is_empty() {
        assert!(child.try_wait().unwrap().is_none(), "the folder is there until the end");
        std::thread::sleep(Duration::from_millis(5));
    }
    let kill = std::process::Command::new("kill").args(["-TERM", &child.id().to_string()]).status().unwrap();
    assert!(kill.success(), "the run was still going");
    assert_eq!(child.wait().unwrap().code(), Some(130));
    assert_eq!(files(folder.path()), [""; 0], "no folder");
}

#[test]
fn loading_is_timed() {
    let folder = tempfile::tempdir().unwrap();
    for backend in ["auto", "cpu"] {
        let report =
            json(folder.path(), &format!("bench load --case 20x16,5,8,4 --runs 2 --dir . --backend {backend} --json"));
        let case = &report["cases"][0];
        assert_eq!((&case["pixels"], &case["window"]), (&320.into(), &5.into()));
        let entries = 320 * 25 * 3 * 4;
        for (name, bytes) in
            [("capture", entries + 128), ("profiles", 12 * 320 * 4 + 108), ("bmpp", 12 * 8 * 4 + 6 * 320 + 156)]
        {
            let storage = &case["storage"][name];
            assert_eq!(storage["bytes"], bytes, "{name}");
            assert!(storage["peak_rss_bytes"].as_u64() > Some(entries), "{name}: more than the largest file");
            let on_device = storage["gpu_bytes"].as_u64().unwrap();
            assert_eq!(on_device > 0, backend == "auto", "{name}: {on_device}");
            for kind in ["warm_us", "cold_us"] {
                let steps = &storage[kind];
                let step = |step: &str| steps[step].as_f64().unwrap_or_else(|| panic!("{name}: {steps}"));
                let sum = step("read") + step("parse") + step("upload") + step("first_frame");
                assert!(sum > 0.0 && step("total") > 0.5 * sum && step("total") < 2.0 * sum, "{name}: {steps}");
            }
        }
        assert!(case["ratios"]["capture_over_bmpp"]["load_warm"].is_number(), "{case}");
    }
    assert_eq!(files(folder.path()), [""; 0], "the files are gone");
}

/// Three files of one material, as `make demo` has them.
#[test]
fn files_of_ones_own_are_timed() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let shape = Shape { size: [12, 10], radius: 2, samples: 4, base_materials: 6, addressing: Addressing::Clamp };
    let choice = BasisChoice::Size(BasisSize { terms: 1, gaussians: 2 });
    let bmpp = add_basis(&shape.bmpp(), &BasisOptions { choice, steps: 0 }, &()).unwrap();
    std::fs::write(folder.join("a.subsurf"), &bmpp).unwrap();
    std::fs::write(folder.join("p.subsurf"), shape.per_pixel()).unwrap();
    let told = succeed(folder, "bench load --files p.subsurf p.subsurf a.subsurf --runs 1 --backend cpu -o .");
    assert!(told.out.contains("12 × 10 pixels, window 5, M = 6, S = 4 (files)"), "{}", told.out);
    assert!(std::fs::read_to_string(folder.join("loading.md")).unwrap().contains("per-pixel profiles over 2-BMPP"));
    let numbers: serde_json::Value =
        serde_json::from_slice(&std::fs::read(folder.join("loading.json")).unwrap()).unwrap();
    assert_eq!(numbers["cases"][0]["storage"]["bmpp"]["bytes"], bmpp.len());
    assert_refused(&run(folder, "bench load --files p.subsurf p.subsurf p.npy"), &["p.npy"]);
}

/// Array in JSON after tables for people.
fn last_json(folder: &Path, args: &str) -> serde_json::Value {
    let out = succeed(folder, args).out;
    let begin = out.find("\n[\n").unwrap_or_else(|| panic!("{args}: no array in {out}"));
    serde_json::from_str(&out[begin..]).unwrap()
}

/// Passes have the names of the shaders' table; Vulkan times them itself. Bytes are told by their purpose.
#[test]
fn frames_are_timed_pass_by_pass() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("a.subsurf"), drawable([13, 11], 3, Addressing::Clamp)).unwrap();
    let rows = last_json(folder, "bench frames a.subsurf --mesh sphere --size 64x48 --frames 1 --json");
    let rows = rows.as_array().unwrap();
    assert_eq!(rows.len(), 8, "four techniques on two devices");
    for row in rows {
        let timed = if row["backend"] == "Vulkan" { "by timestamps" } else { "one by one" };
        assert_eq!(row["passes_timed"], timed, "{row}");
        let has = |pass: &str| row["passes"][pass]["median_ms"].is_number();
        assert!(has("tsm_render"), "{row}");
        let is_blurred = row["path"] == "separable" || row["path"] == "homogeneous";
        for pass in ["separable_gbuffer", "blur_screen", "blur_screen_last", "shade_separable"] {
            assert_eq!(has(pass), is_blurred, "{pass}: {row}");
        }
        let bytes = |purpose: &str| row["bytes"][purpose].as_u64().unwrap();
        assert_eq!(bytes("other"), 64 * 48 * (4 + 4), "the picture and its depth");
        assert_eq!(bytes("light view") == 4 << 20, is_blurred, "{row}");
        assert!(bytes("material") > 0 && bytes("mesh") > 0 && bytes("frame") > 0, "{row}");
    }
}

/// A table for each size, whose sums are those of its rows.
#[test]
fn traffic_of_a_frame_is_counted() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("a.subsurf"), drawable([13, 11], 3, Addressing::Clamp)).unwrap();
    let tables = last_json(folder, "bench traffic a.subsurf --size 64x48 --size 128x96 --json");
    let tables = tables.as_array().unwrap();
    assert_eq!(tables.len(), 4, "one for each size and technique");
    for table in tables {
        let rows = table["passes"].as_array().unwrap();
        let passes: Vec<&str> = rows.iter().map(|row| row["pass"].as_str().unwrap()).collect();
        match table["technique"].as_str() {
            Some("separable") => assert_eq!(
                passes,
                ["tsm_render", "separable_gbuffer", "blur_screen", "sum_screen", "blur_screen_last", "shade_separable"]
            ),
            Some("splat") => {
                assert_eq!(passes[..2], ["tsm_render", "tsm_reduce"]);
                assert_eq!(passes[passes.len() - 3..], ["splat", "splat_resolve", "shade_splat"]);
            }
            other => panic!("{other:?}"),
        }
        let sum: f64 = rows.iter().map(|row| row["bytes_written"].as_f64().unwrap()).sum();
        assert_eq!(table["bytes_written"].as_f64(), Some(sum), "{table}");
    }
}

/// Bases are told apart by what the fit began with and what it came to.
#[test]
fn bases_are_compared() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("a.subsurf"), drawable([13, 11], 3, Addressing::Clamp)).unwrap();
    let told = succeed(folder, "bench basis a.subsurf").out;
    let joint = told.split("L = 2, A = 4, joint").nth(1).expect("a paragraph for every fit");
    let uniform =
        joint.lines().nth(1).and_then(|line| line.split(" / ").next()?.split(' ').next_back()?.parse::<f64>().ok());
    assert!(uniform.is_some_and(|db| db > 25.0), "{told}");
}
