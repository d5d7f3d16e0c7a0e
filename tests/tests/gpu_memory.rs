//! Bytes on the device: within budgets, counted rightly, and given back.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis};
use subsurf_runtime::{Backend, Error, Frame, Gpu, PictureTarget, Purpose, RuntimeOptions};
use subsurf_scene::{AmbientTransfer, Light, Scene, Shadow, torus};
use subsurf_tests::drawable;
use subsurf_tests::frames::{Loaded, RenderMode, SIZE, device, scene};
use subsurf_tests::kernels::{difference, skin};

fn prepared(gpu: &Gpu, loaded: &Loaded, scene: &Scene, budget_bytes: Option<u64>) -> Result<Frame, Error> {
    let options = RuntimeOptions { budget_bytes, ..RuntimeOptions::default() };
    loaded.prepare(gpu, &loaded.renderer(gpu, options)?, scene, SIZE)
}

#[test]
fn budgets_are_kept_or_refused() {
    let file = drawable([31, 31], 6, Addressing::Mirror);
    let mesh = torus(9.0, 4.0, 24);
    let scene = scene(&mesh);
    for gpu in Backend::ALL.map(device) {
        for mode in ["splat", "separable", "gather", "kernel"] {
            let loaded = match mode {
                "splat" => Loaded::new(&gpu, RenderMode::Splat, &file, &mesh),
                "separable" => Loaded::new(&gpu, RenderMode::Separable, &file, &mesh),
                "gather" => Loaded::new(&gpu, RenderMode::Gather, &file, &mesh),
                _ => Loaded::kernel(&gpu, &skin(25).to_bytes().unwrap(), &mesh),
            };
            let before = gpu.ledger().bytes();
            let frame = prepared(&gpu, &loaded, &scene, None).unwrap();
            let whole = gpu.ledger().bytes();
            let best = *frame.plan();
            drop(frame);
            assert_eq!(gpu.ledger().bytes(), before, "{mode}: all of a frame is gone");

            let frame = prepared(&gpu, &loaded, &scene, Some(whole - 1)).unwrap();
            assert!(gpu.ledger().bytes() < whole, "{mode}: {} bytes of {whole}", gpu.ledger().bytes());
            assert_ne!(*frame.plan(), best, "{mode}: something had to become coarser");
            drop(frame);

            match prepared(&gpu, &loaded, &scene, Some(before + 1_000)) {
                Err(Error::OverBudget { need_bytes, budget_bytes }) => {
                    assert!(need_bytes > budget_bytes, "{need_bytes} {budget_bytes}");
                }
                other => panic!("{mode}: {other:?}"),
            }
            assert_eq!(gpu.ledger().bytes(), before, "{mode}: nothing was allocated");
        }
    }
}

/// Loading, resizing and dropping leaves nothing behind, by the ledger and by wgpu's allocator.
#[test]
fn a_thousand_loads_and_resizes_leave_nothing() {
    let gpu = device(Backend::Vulkan);
    let file = drawable([16, 16], 3, Addressing::Mirror);
    let mesh = torus(9.0, 4.0, 8);
    let scene = scene(&mesh);
    let options = RuntimeOptions { light_texels: 128, ..RuntimeOptions::default() };
    let allocated = || gpu.device().generate_allocator_report().map_or(0, |report| report.total_allocated_bytes);
    let shares = AmbientTransfer::of(&mesh, &Bssrdf::parse(&file).unwrap()).unwrap();
    for mode in [RenderMode::Splat, RenderMode::Separable] {
        let load = || Loaded::lit(&gpu, mode, &file, &mesh, &shares);
        let renderer = load().renderer(&gpu, options).unwrap();
        let mut after_some = (0, 0);
        for cycle in 0..1_000_u32 {
            let loaded = load();
            let size = [16 + cycle % 29, 16 + cycle % 31];
            let mut frame = loaded.prepare(&gpu, &renderer, &scene, size).unwrap();
            if cycle % 50 == 0 {
                let _ = loaded.drawn(&gpu, &renderer, &mut frame, &scene, size);
            }
            drop((loaded, frame));
            gpu.finish().unwrap();
            if cycle == 100 {
                after_some = (gpu.ledger().bytes(), allocated());
            }
        }
        println!("{mode:?}: {after_some:?} bytes after 100 cycles, {} after 1000", allocated());
        assert_eq!(gpu.ledger().bytes(), after_some.0, "{mode:?}: by the ledger");
        assert_eq!(gpu.ledger().bytes(), 0, "{mode:?}: by the ledger");
        // The allocator keeps pages; it must not need more and more of them.
        assert!(allocated() <= after_some.1 + (1 << 20), "{mode:?}: {} after {after_some:?}", allocated());
    }
}

/// What one light sees takes 4 MiB at 512 × 512 texels, and a separable frame of 1280 × 720 pixels 20 MB with it and with a
/// picture and its depth: also where the material is so fine on the screen that maps would have the size of the picture.
#[test]
fn views_of_lights_and_separable_frames_are_small() {
    let size = [1280, 720];
    let mesh = torus(9.0, 4.0, 24);
    let near = scene(&mesh);
    let mut far = near.clone();
    far.camera.eye_mm *= 50.0;
    for gpu in Backend::ALL.map(device) {
        for terms in [1, 2] {
            let loaded = Loaded::new(&gpu, RenderMode::Separable, &with_terms(terms), &mesh);
            let kept = Purpose::ALL.map(|purpose| gpu.ledger().bytes_of(purpose));
            let options = RuntimeOptions::default();
            let renderer = loaded.renderer(&gpu, options).unwrap();
            for scene in [&near, &far] {
                let picture = PictureTarget::new(&gpu, size, &options).unwrap();
                let frame = loaded.prepare(&gpu, &renderer, scene, size).unwrap();
                let bytes = Purpose::ALL.map(|purpose| gpu.ledger().bytes_of(purpose) - kept[purpose as usize]);
                println!("L = {terms}, maps {:?}: {bytes:?}", frame.plan().blur_size);
                assert_eq!(frame.plan().light_texels, 512, "texels to a side");
                assert_eq!(bytes[Purpose::LightView as usize], 4 << 20, "of what one light sees");
                assert_eq!(bytes[..2], [0, 0], "a frame has neither materials nor meshes");
                assert_eq!(bytes[Purpose::Other as usize], 1280 * 720 * (4 + 4), "of a picture and its depth");
                let all: u64 = bytes.iter().sum();
                assert!(all <= 20_000_000, "L = {terms}: {all} bytes, {bytes:?}");
                drop((frame, picture));
            }
            // By wish maps are as fine as the picture, and take more.
            let fine = RuntimeOptions { map_bytes_per_pixel: 100.0, ..options };
            let frame = loaded.prepare(&gpu, &loaded.renderer(&gpu, fine).unwrap(), &far, size).unwrap();
            assert_eq!(frame.plan().blur_size, size, "full size");
        }
    }
}

/// Kernels of 25 taps take 1.2 kB as a file, and 1.3 kB with a second term; 2.8 and 4.4 kB on the device. A frame of 1280 × 720 pixels
/// takes 20 MB with the view of its light and its picture; maps have 28 bytes a texel, and 36 where there are several terms.
#[test]
fn kernels_and_their_frames_are_small() {
    let size = [1280, 720];
    let mesh = torus(9.0, 4.0, 24);
    let near = scene(&mesh);
    let mut far = near.clone();
    far.camera.eye_mm *= 50.0;
    for gpu in Backend::ALL.map(device) {
        for (model, file_bytes, gpu_bytes, texel_bytes) in
            [(skin(25), 1_184, 2_816, 28), (difference(25), 1_280, 4_352, 36)]
        {
            let file = model.to_bytes().unwrap();
            let terms = model.terms.len();
            assert!(file.len() <= file_bytes, "{terms} terms: a file of {} bytes", file.len());
            let loaded = Loaded::kernel(&gpu, &file, &mesh);
            assert_eq!(loaded.material.gpu_bytes(), gpu.ledger().bytes_of(Purpose::Material), "{terms} terms");
            println!("{terms} terms: file {}, device {}", file.len(), loaded.material.gpu_bytes());
            assert!(loaded.material.gpu_bytes() <= gpu_bytes, "{terms} terms: {} bytes", loaded.material.gpu_bytes());
            let kept = Purpose::ALL.map(|purpose| gpu.ledger().bytes_of(purpose));
            let options = RuntimeOptions::default();
            let renderer = loaded.renderer(&gpu, options).unwrap();
            for scene in [&near, &far] {
                let picture = PictureTarget::new(&gpu, size, &options).unwrap();
                let frame = loaded.prepare(&gpu, &renderer, scene, size).unwrap();
                let bytes = Purpose::ALL.map(|purpose| gpu.ledger().bytes_of(purpose) - kept[purpose as usize]);
                let [width, height] = frame.plan().blur_size.map(u64::from);
                println!("{terms} terms, maps {width} x {height}: {bytes:?}");
                let maps = texel_bytes * width * height;
                let all: u64 = bytes.iter().sum();
                let others = all - bytes[Purpose::LightView as usize] - bytes[Purpose::Other as usize];
                assert!(maps <= others && others <= maps + 100_000, "{terms} terms: {others} bytes, {maps} of maps");
                assert!(all <= 20_000_000, "{terms} terms: {all} bytes, {bytes:?}");
                drop((frame, picture));
            }
        }
    }
}

/// A small material with a basis of so many terms.
fn with_terms(terms: usize) -> Vec<u8> {
    let choice = BasisChoice::Size(BasisSize { terms, gaussians: 3 });
    let file = drawable([31, 31], 6, Addressing::Mirror);
    add_basis(&file, &BasisOptions { choice, steps: 0 }, &()).unwrap()
}

/// Lights take memory for shadows that are drawn, and for nothing else.
#[test]
fn lights_without_shadows_take_no_memory() {
    let file = drawable([31, 31], 6, Addressing::Mirror);
    let mesh = torus(9.0, 4.0, 24);
    let usual = scene(&mesh);
    let with = |drawn: usize, through: usize| {
        let [drawn, through] = [(Shadow::Drawn, drawn), (Shadow::None, through)]
            .map(|(shadow, count)| vec![Light { shadow, ..usual.lights[0] }; count]);
        Scene { lights: [through, drawn].concat(), ..usual.clone() }
    };
    for gpu in Backend::ALL.map(device) {
        for mode in [RenderMode::Splat, RenderMode::Separable] {
            let loaded = Loaded::new(&gpu, mode, &file, &mesh);
            let taken = |drawn, through| {
                let _frame = prepared(&gpu, &loaded, &with(drawn, through), None).unwrap();
                (gpu.ledger().bytes(), gpu.ledger().bytes_of(Purpose::LightView))
            };
            assert_eq!(taken(1, 0), taken(1, 7), "{mode:?}: one shadow");
            assert_eq!(taken(0, 0), taken(0, 8), "{mode:?}: no shadow");
            let ([one, none, four], [_, least, most]) =
                ([1, 0, 4].map(|drawn| taken(drawn, 0).1), [1, 0, 4].map(|drawn| taken(drawn, 0).0));
            println!("{mode:?}: {one} bytes a shadow; {least} in the ledger with none, {most} with four");
            assert!(none < 100, "{mode:?}: {none} bytes without shadows");
            assert_eq!(four, 4 * one, "{mode:?}: four shadows");
            assert!(most - least >= four - none, "{mode:?}: {most} {least}");
        }
    }
}

/// The ledger counts what wgpu's allocator counts, but for its alignment and what it needs itself.
#[test]
fn the_ledger_agrees_with_the_allocator() {
    let gpu = device(Backend::Vulkan);
    let allocated = || gpu.device().generate_allocator_report().map_or(0, |report| report.total_allocated_bytes);
    let before = allocated();
    let mesh = torus(9.0, 4.0, 48);
    let scene = scene(&mesh);
    let file = drawable([128, 128], 6, Addressing::Mirror);
    for mode in [RenderMode::Splat, RenderMode::Separable] {
        let loaded = Loaded::new(&gpu, mode, &file, &mesh);
        let options = RuntimeOptions::default();
        let renderer = loaded.renderer(&gpu, options).unwrap();
        let frame = loaded.prepare(&gpu, &renderer, &scene, [640, 480]).unwrap();
        gpu.finish().unwrap();
        let (ours, theirs) = (gpu.ledger().bytes(), allocated() - before);
        let by_purpose = Purpose::ALL.map(|purpose| gpu.ledger().bytes_of(purpose));
        println!("{mode:?}: {ours} bytes by the ledger, {by_purpose:?} by purpose, {theirs} by the allocator");
        assert_eq!(by_purpose.iter().sum::<u64>(), ours, "{mode:?}: every byte has a purpose");
        assert!(by_purpose[..4].iter().all(|bytes| *bytes > 0), "{mode:?}: {by_purpose:?}");
        assert!(ours <= theirs && theirs <= ours + ours / 8 + (2 << 20), "{mode:?}: {ours} {theirs}");
        drop((frame, renderer, loaded));
        gpu.finish().unwrap();
    }
}
