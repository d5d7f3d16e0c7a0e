//! Kernels in benchmarks: what is timed is what the twins compute, and they are drawn beside the other techniques.

use glam::Vec4;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::{Bssrdf, Kernel};
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis};
use subsurf_encoder::bssrdf::{HomogeneousPatch, homogeneous};
use subsurf_encoder::kernel::profile::of_base;
use subsurf_encoder::kernel::{Options, Profile, encode};
use subsurf_encoder::synthetic::unit;
use subsurf_runtime::{Backend, KernelScreen, Load, PatchLight};
use subsurf_shaders::cpu;
use subsurf_shaders::uniform::{KernelTerm, ScreenDomain};
use subsurf_tests::frames::device;
use subsurf_tests::kernels::{SKIN, difference, skin};

use crate::common::{assert_refused, json, run, succeed};

/// Relative: two targets of half floats for each term.
const TOLERANCE: f32 = 4.0 / 1024.0;

#[test]
fn blurs_that_are_timed_are_those_of_the_twins() {
    let size = [48, 32];
    let noise: Vec<[f32; 3]> = (0..size[0] * size[1]).map(|pixel| [0, 1, 2].map(|c| unit(3 * pixel + c))).collect();
    let domain =
        ScreenDomain { size, focal_texels: [5.0; 2], middle_mm: 1.0, pitch_mm: 1.0, perspective: 0.0, is_jittered: 1 };
    for (backend, model) in Backend::ALL.into_iter().flat_map(|backend| [(backend, skin(9)), (backend, difference(9))])
    {
        let file = model.to_bytes().unwrap();
        let kernel = Kernel::parse(&file).unwrap();
        let light: Vec<Vec4> = noise.iter().map(|[r, g, b]| Vec4::new(*r, *g, *b, 1.0)).collect();
        let mut expected = vec![Vec4::ZERO; light.len()];
        for [rows, columns] in KernelTerm::of(&kernel) {
            let between = cpu::blur_kernel(&rows, &domain, &light);
            expected = cpu::sum_kernel(&columns, &domain, &between, &expected);
        }
        let gpu = device(backend);
        let material = Load::kernel(&gpu, &kernel).unwrap().finish().unwrap();
        let light = PatchLight::upload(&gpu, size, &noise).unwrap();
        let screen = KernelScreen::new(&gpu, &material, &light, size, 5.0, true).unwrap();
        screen.blur(&gpu, 1).unwrap();
        let found = screen.read(&gpu).unwrap();
        for (found, expected) in found.iter().zip(&expected) {
            let is_close = |c: usize| (found[c] - expected[c]).abs() <= TOLERANCE * expected[c].abs() + 2e-4;
            assert!((0..3).all(is_close), "{backend}: {found:?}, {expected:?}");
        }
        let texels = u64::from(size[0] * size[1]);
        assert_eq!(screen.blur_bytes(), 40 * model.terms.len() as u64 * texels, "a term: 16 bytes, and 24");
        assert_eq!(screen.copy_bytes(), 16 * texels, "in and out");
        screen.copy(&gpu, 2).unwrap();
        gpu.finish().unwrap();
    }
}

#[test]
fn kernels_are_timed_and_drawn_beside_the_gather() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let profile = Profile::of_two_gaussians(&SKIN, [0.8, 0.6, 0.5]).unwrap();
    let patch = HomogeneousPatch { side: 12, radius: 5, pitch_mm: 0.6, eta: 1.4 };
    let choice = BasisChoice::Size(BasisSize { terms: 1, gaussians: 3 });
    let file = homogeneous(&profile, &patch).unwrap();
    let file = add_basis(&file, &BasisOptions { choice, ..BasisOptions::default() }, &()).unwrap();
    let seen = of_base(&Bssrdf::parse(&file).unwrap(), 0).unwrap();
    let kernel = encode(&seen, &Options { eta: 1.4, ..Options::default() }).unwrap().kernel.to_bytes().unwrap();
    std::fs::write(folder.join("a.subsurf"), file).unwrap();
    std::fs::write(folder.join("k.subsurf"), &kernel).unwrap();

    let told = succeed(folder, "bench blur k.subsurf --size 64x48 --runs 1 --blurs 1 --json").out;
    let rows: serde_json::Value = serde_json::from_str(&told[told.find("\n[\n").expect("an array")..]).unwrap();
    for row in rows.as_array().unwrap() {
        let number = |name: &str| row[name].as_f64().unwrap_or_else(|| panic!("{name}: {row}"));
        let ratio = number("blur_ms") / (2.5 * number("copy_ms"));
        assert!(ratio > 0.0 && (number("ratio") / ratio - 1.0).abs() < 1e-9, "{row}");
    }
    let load = json(folder, "bench load --kernel k.subsurf --runs 1 --json");
    assert_eq!(load["storage"]["k"]["bytes"], kernel.len(), "{load}");
    assert!(load["storage"]["k"]["gpu_bytes"].as_u64() > Some(2_000), "{load}");
    assert_refused(&run(folder, "bench load --kernel a.subsurf"), &["a.subsurf", "no kernel"]);
    assert_refused(&run(folder, "bench blur a.subsurf"), &["a.subsurf", "no kernel"]);

    succeed(
        folder,
        "bench render a.subsurf --kernel k.subsurf --mesh sphere --extent 16 --size 160x120 --frames 0 -o out",
    );
    let csv = std::fs::read_to_string(folder.join("out/render.csv")).unwrap();
    let rows: Vec<Vec<&str>> = csv.lines().map(|line| line.split(',').collect()).collect();
    let of_kernel: Vec<_> = rows.iter().filter(|row| row[2] == "\"kernel k\"").collect();
    assert_eq!(of_kernel.len(), 2, "on two devices: {csv}");
    for row in &of_kernel {
        let db: f64 = row[4].parse().unwrap();
        println!("{}: {db} dB from the gather", row[3]);
        assert!(db > 30.0, "{csv}");
    }
    let page = std::fs::read_to_string(folder.join("out/index.html")).unwrap();
    assert!(page.contains("reference, splat, separable, homogeneous, kernel k"), "the order of the pictures");
}
