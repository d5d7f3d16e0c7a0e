//! What paths also have to cope with: lights close by, boxes for texture coordinates, other targets, devices without half
//! floats to draw to.

use glam::Vec3;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_runtime::wgpu::TextureFormat;
use subsurf_runtime::{
    BACKGROUND, Backend, BssrdfPlanes, Error, Gpu, Load, MaterialLayout, PatchLight, PatchRenderer, Region, Renderer,
    RuntimeOptions, SeparableRenderer, TargetFormat, Technique,
};
use subsurf_scene::{Light, LightShape, Mapping, Mesh, Scene, drapery, relief, torus};
use subsurf_shaders::separable::BasisNumbers;
use subsurf_tests::drawable;
use subsurf_tests::frames::{
    API_TOLERANCE, EDGE_PIXELS, Loaded, RenderMode, SIZE, assert_close, device, material_of, psnr, scene,
    share_that_differs,
};

/// [`scene`] with another light, close by.
fn close_light(mesh: &Mesh, shape: impl Fn(Vec3) -> LightShape) -> Scene {
    let usual = scene(mesh);
    let radius = mesh.positions.iter().map(|position| position.length()).fold(0.0, f32::max);
    let position_mm = 3.0 * radius * Vec3::new(0.9, 1.1, 0.35).normalize();
    Scene { lights: vec![Light { shape: shape(position_mm), ..usual.lights[0] }], ..usual }
}

/// Points and cones of light, on a patch that lies on the mesh as on a box.
#[test]
fn lights_close_by_and_boxes_come_close_to_the_gather() {
    let file = material_of("jade");
    let gpus = Backend::ALL.map(device);
    let point = |position_mm| LightShape::Point { position_mm };
    let spot = |position_mm| LightShape::Spot { position_mm, target_mm: Vec3::ZERO, half_angle_rad: 0.3 };
    // As scans are.
    let bare = Mesh { uvs: None, ..relief(12.0, 8, 28) }.charted();
    let cloth = drapery(12.0, 1.0, 5, 32);
    let cases = [
        ("point, box", bare.clone(), Mapping::Box, close_light(&bare, point)),
        ("spot, uv", cloth.clone(), Mapping::Uv([2.0, 1.0]), close_light(&cloth, spot)),
    ];
    for (name, mesh, mapping, scene) in &cases {
        let draw = |gpu: &Gpu, mode| Loaded::under(gpu, mode, &file, mesh, *mapping, scene).picture(gpu, scene, SIZE);
        assert_close(name, &gpus, [(RenderMode::Splat, 32.0), (RenderMode::Separable, 28.0)], draw);
    }
}

/// A target that encodes by itself shows what the shader encodes for another; several samples change edges alone.
#[test]
fn targets_of_srgb_and_of_several_samples_show_the_same() {
    let file = drawable([31, 31], 3, Addressing::Mirror);
    let mesh = torus(9.0, 4.0, 32);
    let scene = scene(&mesh);
    let usual = RuntimeOptions::default();
    for gpu in Backend::ALL.map(device) {
        for mode in [RenderMode::Gather, RenderMode::Splat, RenderMode::Separable] {
            let loaded = Loaded::new(&gpu, mode, &file, &mesh);
            let draw = |options| loaded.picture_with(&gpu, &scene, SIZE, options);
            let plain = draw(usual);
            let is_covered = |k: &usize| plain[*k] != [BACKGROUND; 3];
            // The background is given as the target takes it.
            let there = draw(RuntimeOptions { format: TextureFormat::Rgba8UnormSrgb, ..usual });
            let covered = (0..plain.len()).filter(is_covered);
            let worst =
                covered.flat_map(|k| (0..3).map(move |c| (k, c))).map(|(k, c)| plain[k][c].abs_diff(there[k][c]));
            assert!(worst.max() <= Some(1), "{mode:?}: encoded by the target");

            let smooth = draw(RuntimeOptions { samples: 4, ..usual });
            let width = SIZE[0] as usize;
            let is_inside = |k: &usize| {
                let rows = [k - width, *k, k + width];
                rows.iter().flat_map(|k| [k - 1, *k, k + 1]).all(|k| is_covered(&k))
            };
            let inside = (width + 1..plain.len() - width - 1).filter(is_inside);
            let (a, b): (Vec<_>, Vec<_>) = inside.map(|k| (plain[k], smooth[k])).unzip();
            let db = psnr(&a, &b);
            println!("{mode:?}: {db:.1} dB between one sample and four");
            assert!(db >= 35.0, "{mode:?}: {db} dB");
            assert!(plain != smooth, "{mode:?}: edges are smooth");
        }
    }
}

/// Bits of half floats in integers give the pictures that half floats give; where they cannot, it is said.
#[test]
fn devices_without_half_floats_to_draw_to_draw_the_same() {
    let file = drawable([31, 31], 3, Addressing::Mirror);
    let mesh = torus(9.0, 4.0, 32);
    let scene = scene(&mesh);
    for backend in Backend::ALL {
        let gpu = device(backend);
        assert_eq!(gpu.target_format(), TargetFormat::Half, "{backend}");
        let packed = device(backend).with_target_format(TargetFormat::Packed);
        // Bit for bit, but for what is rounded the other way.
        let exitance = |gpu: &Gpu| {
            let material = BssrdfPlanes::upload(gpu, &Bssrdf::parse(&file).unwrap()).unwrap();
            let irradiance: Vec<[f32; 3]> = (0..31 * 31_u16).map(|k| [f32::from(k), 0.01, -f32::from(k)]).collect();
            let light = PatchLight::upload(gpu, [31; 2], &irradiance).unwrap();
            let renderer = PatchRenderer::new(gpu, material.layout()).unwrap();
            let whole = Region { origin: [0; 2], size: [31; 2] };
            renderer.gather(gpu, &material, &light, whole).unwrap().read(gpu).unwrap()
        };
        let (halves, bits) = (exitance(&gpu), exitance(&packed));
        for (a, b) in halves.iter().flatten().zip(bits.iter().flatten()) {
            assert!((a - b).abs() <= a.abs() / 1024.0 + 6e-8, "{backend}: {a} {b}");
        }
        // The same by separable blurs, after nine roundings on the way.
        let blurred = |gpu: &Gpu| {
            let material = Bssrdf::parse(&file).unwrap();
            let numbers = BasisNumbers::of(&material).unwrap();
            let material = Load::separable(gpu, &material, &numbers).unwrap().finish().unwrap();
            let light = PatchLight::upload(gpu, [31; 2], &[[0.5, 1.0, 2.0]; 31 * 31]).unwrap();
            let renderer = SeparableRenderer::new(gpu, material.terms()).unwrap();
            let patch = renderer.prepare(gpu, &material, &light).unwrap();
            renderer.draw(gpu, &patch).unwrap().read(gpu).unwrap()
        };
        let (halves, bits) = (blurred(&gpu), blurred(&packed));
        let largest = halves.iter().flatten().copied().fold(0.0, f32::max);
        for (a, b) in halves.iter().flatten().zip(bits.iter().flatten()) {
            assert!((a - b).abs() <= 9.0 / 1024.0 * largest, "{backend}: {a} {b} of {largest}");
        }
        for mode in [RenderMode::Gather, RenderMode::Separable] {
            let draw = |gpu: &Gpu| Loaded::new(gpu, mode, &file, &mesh).picture(gpu, &scene, SIZE);
            let share = share_that_differs(&draw(&gpu), &draw(&packed));
            assert!(share <= EDGE_PIXELS, "{backend}, {mode:?}: {share} of pixels differ by more than {API_TOLERANCE}");
        }
        match Renderer::for_technique(&packed, Technique::Splat(MaterialLayout::Bmpp2), RuntimeOptions::default()) {
            Err(Error::NoHalfFloats { what }) => assert_eq!(what, "splats"),
            other => panic!("{other:?}"),
        }
    }
}
