//! Frames of meshes: every path on both APIs, against the reference gather and each other.

use glam::Vec3;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::baseline::song2009::per_pixel_of;
use subsurf_encoder::metrics::psnr_db;
use subsurf_runtime::{BACKGROUND, Backend, Error, Gpu, Input, RuntimeOptions};
use subsurf_scene::{bowl, drapery, knot, torus};
use subsurf_tests::frames::{API_TOLERANCE, Loaded, RenderMode, SIZE, assert_close, device, material_of, scene};
use subsurf_tests::{drawable, shape};

/// Every path against the gather, on meshes thick and thin; and both APIs against each other.
#[test]
fn paths_come_close_to_the_gather_and_apis_to_each_other() {
    let file = material_of("jade");
    let gpus = Backend::ALL.map(device);
    let meshes = [("knot", knot(14.0, 4.5, 32)), ("bowl", bowl(12.0, 2.0, 32)), ("drapery", drapery(12.0, 1.0, 5, 32))];
    for (name, mesh) in &meshes {
        let scene = scene(mesh);
        let draw = |gpu: &Gpu, mode| Loaded::new(gpu, mode, &file, mesh).picture(gpu, &scene, SIZE);
        assert_close(name, &gpus, [(RenderMode::Splat, 36.0), (RenderMode::Separable, 35.0)], draw);
    }
}

/// 2-BMPP and per-pixel profiles of the same numbers give the same splats.
#[test]
fn splats_are_the_same_from_profiles_of_every_pixel() {
    let file = shape([31, 31], 6, Addressing::Mirror).bmpp();
    let profiles = per_pixel_of(&Bssrdf::parse(&file).unwrap());
    let mesh = torus(9.0, 4.0, 32);
    let gpu = device(Backend::Vulkan);
    let draw = |file: &[u8]| Loaded::new(&gpu, RenderMode::Splat, file, &mesh).picture(&gpu, &scene(&mesh), SIZE);
    let (a, b) = (draw(&file), draw(&profiles));
    let worst = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(API_TOLERANCE), "{worst:?}");
}

/// From so far away that a pixel holds many of the material's: as bright as the mean of a large picture, wherever exactly
/// pixels fall.
#[test]
fn far_meshes_do_not_shimmer() {
    const LARGER: u32 = 8;
    let file = material_of("chessboard");
    let mesh = torus(9.0, 4.0, 48);
    let gpu = device(Backend::Vulkan);
    let loaded = Loaded::new(&gpu, RenderMode::Separable, &file, &mesh);
    let mut worst = f64::INFINITY;
    for step in 0..4_u8 {
        let mut far = scene(&mesh);
        far.camera.eye_mm *= 6.0;
        far.camera.target_mm = Vec3::new(0.0, 0.06 * f32::from(step), 0.0);
        let size = [160, 120];
        let small = loaded.picture(&gpu, &far, size);
        let large = loaded.picture(&gpu, &far, size.map(|side| LARGER * side));
        let mean = |x: u32, y: u32| {
            let block = (0..LARGER * LARGER).map(|k| [LARGER * x + k % LARGER, LARGER * y + k / LARGER]);
            let values = block.map(|[x, y]| large[(y * size[0] * LARGER + x) as usize].map(f64::from));
            let sum = values.fold([0.0; 3], |sum, pixel| [0, 1, 2].map(|c| sum[c] + pixel[c]));
            sum.map(|sum| sum / f64::from(255 * LARGER * LARGER))
        };
        // Where blocks are covered whole: edges are a matter of samples.
        let is_inside = |x: u32, y: u32| {
            (0..LARGER * LARGER).all(|k| {
                let at = (LARGER * y + k / LARGER) * size[0] * LARGER + LARGER * x + k % LARGER;
                large[at as usize] != [BACKGROUND; 3]
            })
        };
        let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        let inside: Vec<(u32, u32)> = places.filter(|(x, y)| is_inside(*x, *y)).collect();
        let reference: Vec<[f64; 3]> = inside.iter().map(|(x, y)| mean(*x, *y)).collect();
        let found: Vec<[f64; 3]> = inside
            .iter()
            .map(|(x, y)| small[(y * size[0] + x) as usize].map(|value| f64::from(value) / 255.0))
            .collect();
        assert!(inside.len() > 50, "{} pixels", inside.len());
        worst = worst.min(psnr_db(&reference, &found));
    }
    println!("far away: at least {worst:.1} dB from {LARGER} × {LARGER} samples to a pixel");
    assert!(worst >= 32.0, "{worst} dB");
}

/// An application's own device draws what ours draws.
#[test]
fn a_device_of_the_callers_own_draws_the_same() {
    let file = drawable([31, 31], 6, Addressing::Mirror);
    let mesh = torus(9.0, 4.0, 24);
    let scene = scene(&mesh);
    let ours = device(Backend::Vulkan);
    let theirs = Gpu::from_device(ours.device().clone(), ours.queue().clone(), ours.info().clone());
    let draw = |gpu: &Gpu| Loaded::new(gpu, RenderMode::Separable, &file, &mesh).picture(gpu, &scene, SIZE);
    assert!(draw(&ours) == draw(&theirs), "the same picture");
    let kept = Loaded::new(&ours, RenderMode::Separable, &file, &mesh);
    assert!(ours.ledger().bytes() > 0, "{:?} is there", kept.material.technique());
    assert_eq!(theirs.ledger().bytes(), 0, "each has a ledger of its own");
}

/// Points belong to the mesh whose vertices name them.
#[test]
fn points_of_another_surface_are_refused() {
    let file = drawable([31, 31], 6, Addressing::Mirror);
    let gpu = device(Backend::Vulkan);
    let [large, small] = [torus(9.0, 4.0, 24), torus(4.0, 1.5, 24)];
    let of = |mesh| Loaded::new(&gpu, RenderMode::Gather, &file, mesh);
    let mixed = Loaded { mesh: of(&large).mesh, ..of(&small) };
    let scene = scene(&large);
    let renderer = mixed.renderer(&gpu, RuntimeOptions::default()).unwrap();
    let mut frame = mixed.prepare(&gpu, &renderer, &scene, SIZE).unwrap();
    let objects = [mixed.object(&scene)];
    match renderer.gather(&gpu, &mut frame, &Input::new(&scene, &objects, SIZE)) {
        Err(Error::Usage(reason)) => assert!(reason.contains("another surface"), "{reason}"),
        other => panic!("{other:?}"),
    }
}
