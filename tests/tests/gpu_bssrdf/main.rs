//! Every pass on Vulkan and on OpenGL ES 3.0 against its CPU twin.
//!
//! The GL backend must really be GLES 3.0: `.cargo/config.toml` sets Mesa's overrides for `cargo test`.

mod kernel;
mod kernel_transmission;
mod projected;

use std::sync::Arc;

use glam::Vec3;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::basis::BasisSize;
use subsurf_decoder::bssrdf::{Addressing, Coding};
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis};
use subsurf_encoder::synthetic::{Shape, capture_row, unit};
use subsurf_runtime::{
    BACKGROUND, Backend, BssrdfPlanes, GatherMaterial, Gpu, GpuMesh, GpuPoints, Input, Load, Material, MaterialLayout,
    Object, PatchLight, PatchRenderer, PictureTarget, Region, Renderer, RuntimeOptions, SeparableRenderer, Technique,
    VertexData, layout_of,
};
use subsurf_scene::{
    Camera, Environment, Light, LightShape, MAX_LIGHTS, Mapping, Mesh, Placement, REFLECTION_SIZE, Scene, Shadow,
    SurfacePoints, relief, sphere, torus,
};
use subsurf_shaders::separable::ProjectedBasis;
use subsurf_shaders::{cpu, uniform};
use subsurf_tests::shape;

/// Targets are half floats: software drivers truncate to 11 bits, so that every target on the way costs up to 2⁻¹⁰.
const HALF_ULP: f32 = 1.0 / 1024.0;
/// What sums of some hundred f32 terms with another `exp` differ by.
const SUM_TOLERANCE: f32 = 2e-5;
/// Display values: one step of 255, for rounding.
const DISPLAY_TOLERANCE: u8 = 1;
/// Share of a picture's pixels that may differ more: drivers snap vertices to a grid of subpixels, and a pixel on an
/// edge goes to one triangle or the other.
const EDGE_PIXELS: f64 = 0.004;

fn open(backend: Backend) -> Gpu {
    let gpu = Gpu::open(backend).unwrap_or_else(|error| panic!("{error}: run `make test`, which installs one"));
    let info = gpu.info();
    println!("{backend}: {}, {} {}", info.name, info.driver, info.driver_info);
    if backend == Backend::Gl {
        assert!(info.driver_info.starts_with("OpenGL ES"), "not GLES: {}", info.driver_info);
        if info.driver_info.contains("Mesa") {
            assert!(info.driver_info.starts_with("OpenGL ES 3.0"), "not forced to 3.0: {}", info.driver_info);
        }
    }
    gpu
}

/// Asserts that results differ by no more than `targets` half-float targets in a row may.
fn assert_close(found: &[[f32; 3]], expected: &[[f32; 3]], targets: f32, what: &str) {
    let tolerance = targets * HALF_ULP + SUM_TOLERANCE;
    assert_eq!(found.len(), expected.len(), "{what}");
    let mut worst = 0.0_f32;
    for (at, (found, expected)) in found.iter().zip(expected).enumerate() {
        for c in 0..3 {
            let error = (found[c] - expected[c]).abs() / expected[c].abs().max(1e-4);
            assert!(error <= tolerance, "{what}: {found:?} is not {expected:?} at {at}");
            worst = worst.max(error);
        }
    }
    println!("{what}: largest relative difference {worst:.2e}");
}

fn file(layout: MaterialLayout, shape: &Shape) -> Vec<u8> {
    match layout {
        MaterialLayout::Bmpp1 => shape.k_bmpp(1, Coding::Exact, false),
        MaterialLayout::Bmpp2 => shape.bmpp(),
        MaterialLayout::Bmpp2Palette => shape.k_bmpp(2, Coding::Palette, false),
        MaterialLayout::Bmpp3 => shape.k_bmpp(3, Coding::Exact, false),
        MaterialLayout::Bmpp5 => shape.k_bmpp(5, Coding::Exact, false),
        MaterialLayout::PerPixel => shape.per_pixel(),
        MaterialLayout::Capture => panic!("captures are not files"),
    }
}

const FITTED: [MaterialLayout; 6] = [
    MaterialLayout::Bmpp1,
    MaterialLayout::Bmpp2,
    MaterialLayout::Bmpp2Palette,
    MaterialLayout::Bmpp3,
    MaterialLayout::Bmpp5,
    MaterialLayout::PerPixel,
];

/// Kinds that share a layout with others: 8-bit ratios, half floats, and more base materials than a column holds.
fn variants(shape: &Shape) -> [Vec<u8>; 3] {
    let many = Shape { base_materials: 2_500, ..*shape };
    [
        shape.k_bmpp(2, Coding::SmallRatios, false),
        shape.k_bmpp(3, Coding::Exact, true),
        many.k_bmpp(1, Coding::Exact, false),
    ]
}

/// Bright here, dark there, coloured.
fn patterned_light(size: [u32; 2]) -> Vec<[f32; 3]> {
    (0..size[0] * size[1]).map(|pixel| [0, 1, 2].map(|c| 2.0 * unit(7 * pixel + c).powi(2))).collect()
}

fn patch(backend: Backend) {
    let gpu = open(backend);
    let size = [23, 17];
    let irradiance = patterned_light(size);
    for layout in FITTED {
        let renderer = PatchRenderer::new(&gpu, layout).unwrap();
        for addressing in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
            // The second window is wider than the patch: it wraps more than once.
            for radius in [4, 20] {
                let file = file(layout, &shape(size, radius, addressing));
                let material = Bssrdf::parse(&file).unwrap();
                let what = format!("{backend}, {layout:?}, {addressing:?}, radius {radius}");
                let uploaded = BssrdfPlanes::upload(&gpu, &material).unwrap();
                let light = PatchLight::upload(&gpu, size, &irradiance).unwrap();
                let region = Region { origin: [2, 1], size: [21, 16] };
                let exitance = renderer.gather(&gpu, &uploaded, &light, region).unwrap();
                let expected = cpu::gather(&material, &irradiance, region.origin, region.size);
                let found = exitance.read(&gpu).unwrap();
                assert_close(&found, &expected, 1.0, &what);

                let pixels = [64, 40];
                let picture = renderer.picture(&gpu, &exitance, pixels, 3.0).unwrap();
                let expected = cpu::present(&found, region.size, pixels, 3.0);
                let worst = picture.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| a.abs_diff(*b)).max();
                assert!(worst <= Some(DISPLAY_TOLERANCE), "{what}: pictures differ by {worst:?}");
            }
        }
    }
}

/// Maps, blurs along rows and columns, and their sum are half floats, with weights of both signs: errors are compared with
/// the brightest value.
fn separable(backend: Backend) {
    let gpu = open(backend);
    let size = [23, 17];
    let irradiance = patterned_light(size);
    for addressing in [Addressing::Clamp, Addressing::Repeat, Addressing::Mirror] {
        // The second window is wider than the patch: it wraps more than once.
        for (radius, terms, gaussians) in [(4, 2, 4), (20, 2, 2), (4, 1, 6)] {
            let choice = BasisChoice::Size(BasisSize { terms, gaussians });
            let file = shape(size, radius, addressing).bmpp();
            let file = add_basis(&file, &BasisOptions { choice, ..BasisOptions::default() }, &()).unwrap();
            let material = Bssrdf::parse(&file).unwrap();
            let basis = ProjectedBasis::of(&material).unwrap();
            let uploaded = Load::separable(&gpu, &material, basis.numbers()).unwrap().finish().unwrap();
            let light = PatchLight::upload(&gpu, size, &irradiance).unwrap();
            let renderer = SeparableRenderer::new(&gpu, terms).unwrap();
            let patch = renderer.prepare(&gpu, &uploaded, &light).unwrap();
            let found = renderer.draw(&gpu, &patch).unwrap().read(&gpu).unwrap();
            let expected = basis.exitance(&irradiance);
            let largest = expected.iter().flatten().copied().fold(0.0, f32::max);
            let errors = found.iter().flatten().zip(expected.iter().flatten()).map(|(a, b)| (a - b).abs() / largest);
            let worst = errors.fold(0.0, f32::max);
            println!(
                "{backend}, {addressing:?}, radius {radius}, L = {terms}, A = {gaussians}: {worst:.2e} of the brightest"
            );
            // The first map, two for each stage, the sum and the exitance.
            let targets = (2 * gaussians + 3) as f32;
            assert!(worst <= targets * HALF_ULP + SUM_TOLERANCE, "{backend}, {addressing:?}, radius {radius}: {worst}");
        }
    }
}

#[test]
fn separable_on_vulkan() {
    separable(Backend::Vulkan);
}

#[test]
fn separable_on_gles_3_0() {
    separable(Backend::Gl);
}

fn patch_variants(backend: Backend) {
    let gpu = open(backend);
    let size = [23, 17];
    let irradiance = patterned_light(size);
    for (number, file) in variants(&shape(size, 4, Addressing::Clamp)).iter().enumerate() {
        let material = Bssrdf::parse(file).unwrap();
        let renderer = PatchRenderer::new(&gpu, layout_of(&material)).unwrap();
        let uploaded = BssrdfPlanes::upload(&gpu, &material).unwrap();
        let light = PatchLight::upload(&gpu, size, &irradiance).unwrap();
        let found = renderer.gather(&gpu, &uploaded, &light, Region { origin: [0, 0], size }).unwrap();
        let expected = cpu::gather(&material, &irradiance, [0, 0], size);
        assert_close(&found.read(&gpu).unwrap(), &expected, 1.0, &format!("{backend}, variant {number}"));
    }
}

#[test]
fn variants_on_vulkan() {
    patch_variants(Backend::Vulkan);
}

#[test]
fn variants_on_gles_3_0() {
    patch_variants(Backend::Gl);
}

#[test]
fn patch_on_vulkan() {
    patch(Backend::Vulkan);
}

#[test]
fn patch_on_gles_3_0() {
    patch(Backend::Gl);
}

fn capture_patch(backend: Backend) {
    // The entries that a 2-BMPP file stands for: drawing them must give what drawing the file gives.
    let gpu = open(backend);
    let size = [12, 9];
    let file = shape(size, 3, Addressing::Repeat).bmpp();
    let material = Bssrdf::parse(&file).unwrap();
    let entries = (0..size[1]).flat_map(|y| capture_row(&material, y));
    let entries: Vec<u8> = entries.flat_map(f32::to_le_bytes).collect();
    let irradiance = patterned_light(size);
    let renderer = PatchRenderer::new(&gpu, MaterialLayout::Capture).unwrap();
    let uploaded = BssrdfPlanes::upload_capture(&gpu, material.header(), &entries).unwrap();
    let light = PatchLight::upload(&gpu, size, &irradiance).unwrap();
    let region = Region { origin: [0, 0], size };
    let found = renderer.gather(&gpu, &uploaded, &light, region).unwrap().read(&gpu).unwrap();
    let expected = cpu::gather(&material, &irradiance, region.origin, size);
    assert_close(&found, &expected, 1.0, &format!("{backend}, capture"));
}

#[test]
fn capture_on_vulkan() {
    capture_patch(Backend::Vulkan);
}

#[test]
fn capture_on_gles_3_0() {
    capture_patch(Backend::Gl);
}

/// A light with a shadow, one nearby, one within a cone, three weak ones, and a sky that is brighter above.
fn scene() -> Scene {
    let sky: Vec<[f32; 3]> = (0..16 * 8).map(|k| [0.3, 0.25, 0.2].map(|c| c * (2.0 - (k / 16) as f32 / 8.0))).collect();
    let light = |shape, irradiance| Light { shape, irradiance, shadow: Shadow::Drawn };
    Scene {
        lights: vec![
            light(LightShape::Directional { towards: Vec3::new(0.5, 1.0, 0.8) }, [3.0, 2.8, 2.5]),
            light(LightShape::Point { position_mm: Vec3::new(-14.0, 4.0, 6.0) }, [0.8, 0.5, 0.2]),
            light(
                LightShape::Spot { position_mm: Vec3::new(3.0, 9.0, 16.0), target_mm: Vec3::X, half_angle_rad: 0.25 },
                [0.1, 0.3, 0.9],
            ),
            light(LightShape::Directional { towards: Vec3::new(-0.7, 0.1, 0.4) }, [0.1, 0.05, 0.2]),
            light(LightShape::Directional { towards: Vec3::new(-0.2, -0.9, 0.5) }, [0.5, 0.1, 0.1]),
            light(LightShape::Directional { towards: Vec3::new(0.9, -0.1, 0.1) }, [0.1, 0.4, 0.1]),
        ],
        environment: Environment::equirectangular([16, 8], &sky).unwrap(),
        roughness: 0.3,
        camera: Camera { eye_mm: Vec3::new(10.0, 12.0, 25.0), target_mm: Vec3::ZERO, fov_y_rad: 0.6, exposure: 0.35 },
    }
}

fn mesh_scene(backend: Backend, mesh: &Mesh, mapping: Mapping, layout: MaterialLayout, what: &str) {
    let gpu = open(backend);
    let file = file(layout, &shape([31, 31], 6, Addressing::Clamp));
    let material = Bssrdf::parse(&file).unwrap();
    let what = format!("{backend}, {what}, {layout:?}");
    // Shadows over half of it, with soft edges, in the steps that the device keeps.
    let soft = |x: f32| ((0.5 + 0.2 * x).clamp(0.0, 1.0) * 255.0).round() / 255.0;
    let of_lights = |p: &Vec3| [soft(p.x), soft(-p.y), soft(p.z), 1.0, soft(p.y), soft(-p.z), 1.0, 1.0];
    let visibilities: Vec<[f32; MAX_LIGHTS]> = mesh.positions.iter().map(of_lights).collect();
    let surface = SurfacePoints::new(mesh, mapping, material.header(), &visibilities);
    let size = [160, 120];
    let scene = scene();
    let placement = Placement::new(mesh, mapping, material.header());

    let options = RuntimeOptions::default();
    let renderer = Renderer::for_technique(&gpu, Technique::Gather(layout), options).unwrap();
    let points = GpuPoints::upload(&gpu, &surface).unwrap();
    let gathered = Arc::new(GatherMaterial { planes: BssrdfPlanes::upload(&gpu, &material).unwrap(), points });
    let known = VertexData { points: Some(&surface.point_of), ..Default::default() };
    let on_gpu = GpuMesh::upload(&gpu, mesh, known).unwrap();
    let uploaded = Material::Gather(gathered.clone());
    let objects = [Object::new(&on_gpu, &uploaded, mapping, scene.roughness)];
    let input = Input::new(&scene, &objects, size);
    let mut frame = renderer.prepare(&gpu, &input, size).unwrap();
    let target = PictureTarget::new(&gpu, size, &options).unwrap();
    let picture = renderer.picture(&gpu, &mut frame, &input, &target).unwrap();
    let found = gathered.points.read(&gpu).unwrap();

    let block = uniform::Blocks::new(&scene, &placement, size, options.light_texels);
    let expected = cpu::surface_gather(&material, &surface, &cpu::irradiance(&block, &surface));
    // Irradiance and exitance.
    assert_close(&found, &expected, 2.0, &what);

    let of_vertices = surface.of_vertices(&found);
    let triangles = cpu::Triangles {
        positions: &mesh.positions,
        normals: &mesh.normals,
        exitances: &of_vertices,
        visibilities: &visibilities,
        triangles: &mesh.triangles,
    };
    let reflections = cpu::Reflections { size: REFLECTION_SIZE, levels: scene.environment.reflections() };
    let expected = cpu::shade_vertex(&triangles, &block, &reflections, size, [BACKGROUND; 3]);
    let different = different(&picture, &expected, DISPLAY_TOLERANCE);
    let covered = expected.iter().filter(|pixel| **pixel != [BACKGROUND; 3]).count();
    println!("{what}: {different} of {} pixels differ, {covered} are covered", picture.len());
    assert!(covered * 10 > picture.len(), "{what}: the mesh is in the picture");
    assert!(different as f64 <= EDGE_PIXELS * picture.len() as f64, "{what}: {different} pixels differ");
}

/// Pixels of two pictures that differ by more than a tolerance in some channel.
fn different(a: &[[u8; 3]], b: &[[u8; 3]], tolerance: u8) -> usize {
    let differs = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).any(|c| a[c].abs_diff(b[c]) > tolerance);
    a.iter().zip(b).filter(|pair| differs(*pair)).count()
}

fn meshes(backend: Backend) {
    let ball = sphere(5.0, 24);
    mesh_scene(backend, &ball, Mapping::Box, MaterialLayout::Bmpp2, "sphere, box mapping");
    let bumpy = Mesh { uvs: None, ..relief(5.0, 8, 14) }.charted();
    mesh_scene(backend, &bumpy, Mapping::Box, MaterialLayout::Bmpp2Palette, "bumpy sphere, charts");
    mesh_scene(backend, &ball, Mapping::Uv([2.0, 1.0]), MaterialLayout::PerPixel, "sphere, texture coordinates");
    for layout in [MaterialLayout::Bmpp2, MaterialLayout::Bmpp1, MaterialLayout::Bmpp2Palette, MaterialLayout::Bmpp5] {
        mesh_scene(backend, &torus(5.0, 2.0, 20), Mapping::Uv([4.0, 2.0]), layout, "torus");
    }
}

#[test]
fn meshes_on_vulkan() {
    meshes(Backend::Vulkan);
}

#[test]
fn meshes_on_gles_3_0() {
    meshes(Backend::Gl);
}

fn ledger(backend: Backend) {
    let gpu = open(backend);
    let file = shape([40, 30], 5, Addressing::Clamp).bmpp();
    let material = Bssrdf::parse(&file).unwrap();
    assert_eq!(gpu.ledger().bytes(), 0, "nothing yet");
    let uploaded = BssrdfPlanes::upload(&gpu, &material).unwrap();
    // Profiles in four channels, planes as they stand in the file, and 48 bytes of uniforms.
    let planes = 16 * 7 * 7 + 6 * 40 * 30;
    assert_eq!(uploaded.gpu_bytes(), planes + 48, "of the material");
    assert_eq!(gpu.ledger().bytes(), planes + 48, "of everything");
    drop(uploaded);
    assert_eq!(gpu.ledger().bytes(), 0, "all gone");

    let other = PatchRenderer::new(&gpu, MaterialLayout::PerPixel).unwrap();
    let uploaded = BssrdfPlanes::upload(&gpu, &material).unwrap();
    let light = PatchLight::upload(&gpu, [40, 30], &patterned_light([40, 30])).unwrap();
    let region = Region { origin: [0, 0], size: [4, 4] };
    assert!(other.gather(&gpu, &uploaded, &light, region).is_err(), "a renderer for another layout");
}

#[test]
fn ledger_on_vulkan() {
    ledger(Backend::Vulkan);
}

#[test]
fn ledger_on_gles_3_0() {
    ledger(Backend::Gl);
}
