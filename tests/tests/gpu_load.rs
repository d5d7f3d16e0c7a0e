//! Load size of every storage and technique, from bytes to the first frame, beside the uncompressed baseline; and loads in steps,
//! beside frames.
//!
//! Bytes are asserted as they are, in the file and on the device. How long it takes is measured by `subsurf-study bench load`.

use std::time::Duration;

use glam::Vec3;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::{Bssrdf, File};
use subsurf_encoder::synthetic::{NestedShape, capture_row};
use subsurf_runtime::{
    Backend, BtfLayout, Error, Gpu, Load, LoadPhase, LoadTimer, Material, RawImages, RuntimeOptions, Stored, Technique,
    layout_of,
};
use subsurf_scene::{Mapping, torus};
use subsurf_tests::frames::{Loaded, RenderMode, device, scene};
use subsurf_tests::{drawable, shape};

/// Material as it is stored, how it is loaded, and the bytes that it takes in both places.
struct Case<'a> {
    name: &'static str,
    bytes: &'a [u8],
    stored: Stored,
    file_bytes: usize,
    gpu_bytes: u64,
}

/// Loads every case twice, and asserts its bytes and what the device does of it: a load that is said to be an upload has no
/// passes, and a projection's passes are told apart from the upload.
fn assert_loads(gpu: &Gpu, cases: &[Case<'_>]) {
    for Case { name, bytes, stored, file_bytes, gpu_bytes } in cases {
        assert_eq!(bytes.len(), *file_bytes, "{name}: bytes");
        let projected = matches!(stored, Stored::File(Technique::Splat(_) | Technique::Separable(_)));
        let timer = LoadTimer::new(gpu, stored.clone()).unwrap();
        for _ in 0..2 {
            let times = timer.load(bytes).unwrap();
            assert_eq!(times.gpu_bytes, *gpu_bytes, "{name}: bytes on the device");
            assert_eq!(times.recording > Duration::ZERO, projected, "{name}: passes of a projection");
        }
    }
}

fn translucent(gpu: &Gpu) {
    let shape = shape([64, 64], 12, Addressing::Clamp);
    let (bmpp, profiles) = (shape.bmpp(), shape.per_pixel());
    let with_basis = drawable([64, 64], 12, Addressing::Clamp);
    let [material, per_pixel] = [&bmpp, &profiles].map(|bytes| Bssrdf::parse(bytes).unwrap());
    let rows = (0..64).flat_map(|y| capture_row(&material, y));
    let capture: Vec<u8> = rows.flat_map(f32::to_le_bytes).collect();
    let terms = Bssrdf::parse(&with_basis).unwrap().basis().map_or(0, |basis| basis.size().terms);
    let [of_planes, of_profiles] = [&material, &per_pixel].map(layout_of);
    let case = |name, bytes, stored, file_bytes, gpu_bytes| Case { name, bytes, stored, file_bytes, gpu_bytes };
    let capture_stored = Stored::Capture(*material.header());
    let splat = |layout| Stored::File(Technique::Splat(layout));
    assert_loads(
        gpu,
        &[
            case("capture, gather", &capture, capture_stored, 30_720_000, 30_720_048),
            case("profiles, gather", &profiles, Stored::Planes(of_profiles), 688_236, 704_560),
            case("profiles, splat", &profiles, splat(of_profiles), 688_236, 791_936),
            case("2-BMPP, gather", &bmpp, Stored::Planes(of_planes), 25_908, 26_192),
            case("2-BMPP, splat", &bmpp, splat(of_planes), 25_908, 113_568),
            case("2-BMPP, separable", &with_basis, Stored::File(Technique::Separable(terms)), 26_432, 134_136),
        ],
    );
}

fn textured(gpu: &Gpu) {
    let shape = NestedShape { materials: vec![(32, 32, 1)], ..NestedShape::typical() };
    let nested = shape.database(1).to_bytes();
    let images: Vec<u8> =
        (0..37 * 37 * 32 * 32 * 3_u32).map(|k| k.wrapping_mul(2_654_435_761).to_le_bytes()[3]).collect();
    let raw = RawImages { size: [32; 2], lights: directions(), views: directions() };
    let case = |name, bytes, stored, file_bytes, gpu_bytes| Case { name, bytes, stored, file_bytes, gpu_bytes };
    assert_loads(
        gpu,
        &[
            case("images", &images, Stored::Images(raw), 4_205_568, 6_365_728),
            case("nested codebooks", &nested, Stored::File(Technique::Btf(BtfLayout::Nested)), 197_680, 205_856),
        ],
    );
}

/// Directions on rings around the normal.
fn directions() -> Vec<Vec3> {
    let ring = |theta: f32, count: u16| {
        (0..count).map(move |k| {
            let phi = f32::from(k) / f32::from(count) * std::f32::consts::TAU;
            Vec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
        })
    };
    ring(0.0, 1).chain(ring(0.5, 12)).chain(ring(1.1, 24)).collect()
}

#[test]
fn loading_on_vulkan() {
    let gpu = device(Backend::Vulkan);
    translucent(&gpu);
    textured(&gpu);
}

#[test]
fn loading_on_gles_3_0() {
    let gpu = device(Backend::Gl);
    translucent(&gpu);
    textured(&gpu);
}

fn assert_send<T: Send>(it: T) -> T {
    it
}

/// Another thread loads, step by step, while this one draws: both give what they give alone.
#[test]
fn another_thread_loads_while_frames_are_drawn() {
    let shown = drawable([31, 31], 6, Addressing::Mirror);
    // Large enough for several steps.
    let coming = drawable([640, 500], 6, Addressing::Repeat);
    let file = File::parse(&coming).unwrap();
    let mesh = torus(9.0, 4.0, 32);
    let scene = scene(&mesh);
    let size = [64, 48];
    for backend in Backend::ALL {
        let gpu = device(backend);
        let first = Loaded::new(&gpu, RenderMode::Separable, &shown, &mesh);
        let renderer = first.renderer(&gpu, RuntimeOptions::default()).unwrap();
        let mut frame = first.prepare(&gpu, &renderer, &scene, size).unwrap();
        let alone = first.drawn(&gpu, &renderer, &mut frame, &scene, size);

        let (loaded, shares, drawn) = std::thread::scope(|threads| {
            let (gpu, file) = (&gpu, &file);
            let loading = threads.spawn(move || {
                let mut load = assert_send(Load::new(gpu, file).unwrap());
                let mut shares = vec![(load.phase(), load.share())];
                while load.step().unwrap() < 1.0 {
                    shares.push((load.phase(), load.share()));
                }
                (assert_send(load.finish().unwrap()), shares)
            });
            let mut drawn = 0;
            while drawn == 0 || !loading.is_finished() {
                assert!(first.drawn(gpu, &renderer, &mut frame, &scene, size) == alone, "{backend}: frame {drawn}");
                drawn += 1;
            }
            let (loaded, shares) = loading.join().unwrap();
            (loaded, shares, drawn)
        });
        println!("{backend}: {drawn} frames while a material was loaded in {} steps", shares.len());
        assert!(shares.windows(2).all(|pair| pair[0].1 < pair[1].1), "{backend}: {shares:?}");
        assert_eq!(shares[0], (Some(LoadPhase::Upload), 0.0), "{backend}");
        assert_eq!(shares.last().unwrap().0, Some(LoadPhase::Projection), "{backend}");

        let again = Material::load(&gpu, &file).unwrap();
        let [there, here] = [loaded, again].map(|material| {
            Loaded {
                mesh: Loaded::new(&gpu, RenderMode::Separable, &shown, &mesh).mesh,
                material,
                mapping: Mapping::Box,
            }
            .picture(&gpu, &scene, size)
        });
        assert!(there == here && there != alone, "{backend}: a material is the same whichever thread loaded it");

        // A load that is stopped leaves nothing behind; one whose device is lost says so, once and for all.
        let before = gpu.ledger().bytes();
        let mut load = Load::new(&gpu, &file).unwrap();
        load.step().unwrap();
        assert!(gpu.ledger().bytes() > before, "{backend}");
        drop(load);
        assert_eq!(gpu.ledger().bytes(), before, "{backend}");
        let mut load = Load::new(&gpu, &file).unwrap();
        gpu.device().destroy();
        assert!(matches!(load.step(), Err(Error::Device(_))), "{backend}");
        assert!(matches!(load.finish(), Err(Error::Usage(_))), "{backend}");
        assert!(matches!(Material::load(&gpu, &file), Err(Error::Device(_))), "{backend}");
    }
}
