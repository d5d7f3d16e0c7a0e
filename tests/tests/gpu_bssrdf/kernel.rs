//! Separable kernels on the screen: against their twin, on planes whose light is known, and beside other materials.

use std::f32::consts::PI;

use glam::{Vec3, Vec4};
use subsurf_decoder::{File, Kernel};
use subsurf_encoder::kernel::Kernel as KernelModel;
use subsurf_runtime::{
    BACKGROUND, Backend, Gpu, GpuMesh, Input, Load, Material, Object, PictureTarget, Renderer, RuntimeOptions,
    TargetFormat, Technique, VertexData,
};
use subsurf_scene::{
    Camera, Environment, Light, LightShape, Mapping, Mesh, Placement, REFLECTION_SIZE, Scene, Shadow, sphere,
};
use subsurf_shaders::cpu;
use subsurf_shaders::uniform::{Blocks, KernelProfile, KernelTerm, ScreenDomain};
use subsurf_tests::kernels::{SKIN, difference, share_beyond, skin};

use super::{EDGE_PIXELS, different, open};

/// Display values after four targets of half floats in a row.
const KERNEL_TOLERANCE: u8 = 2;

/// Options of all pictures here: maps of a texel to a pixel.
fn fine() -> RuntimeOptions {
    RuntimeOptions { map_bytes_per_pixel: 100.0, jittered_taps: false, ..RuntimeOptions::default() }
}

pub(super) fn light(towards: Vec3, irradiance: [f32; 3]) -> Light {
    Light { shape: LightShape::Directional { towards }, irradiance, shadow: Shadow::None }
}

/// Draws some meshes, each of a file.
pub(super) fn drawn(
    gpu: &Gpu,
    of: &[(&Mesh, &[u8])],
    scene: &Scene,
    size: [u32; 2],
    options: RuntimeOptions,
) -> Vec<[u8; 3]> {
    let renderer = Renderer::for_technique(gpu, Technique::Kernel, options).unwrap();
    let load = |(mesh, bytes): &(&Mesh, &[u8])| {
        let material = Load::new(gpu, &File::parse(bytes).unwrap()).unwrap().finish().unwrap();
        (GpuMesh::upload(gpu, mesh, VertexData::default()).unwrap(), material)
    };
    let loaded: Vec<(GpuMesh, Material)> = of.iter().map(load).collect();
    let objects: Vec<_> =
        loaded.iter().map(|(mesh, material)| Object::new(mesh, material, Mapping::Box, scene.roughness)).collect();
    let input = Input::new(scene, &objects, size);
    let mut frame = renderer.prepare(gpu, &input, size).unwrap();
    let target = PictureTarget::new(gpu, size, &options).unwrap();
    renderer.picture(gpu, &mut frame, &input, &target).unwrap()
}

/// The same by the twins of the passes, of one mesh.
fn by_twins(kernel: &Kernel<'_>, is_jittered: bool, mesh: &Mesh, scene: &Scene, size: [u32; 2]) -> Vec<[u8; 3]> {
    let bounds = mesh.bounding_sphere();
    let placement = Placement::of_homogeneous_within(bounds, kernel.header().eta);
    let blocks = Blocks::new(scene, &placement, size, 512);
    let view = subsurf_scene::View::new(&scene.camera, &bounds, size[0] as f32 / size[1] as f32);
    let focal = view.focal();
    let domain = ScreenDomain {
        size,
        focal_texels: [0.5 * size[0] as f32 * focal.x, 0.5 * size[1] as f32 * focal.y],
        middle_mm: (bounds.centre_mm - view.eye_mm()).dot(view.forward()),
        pitch_mm: 1.0,
        perspective: 1.0,
        is_jittered: u32::from(is_jittered),
    };
    let triangles = cpu::KernelMesh { positions: &mesh.positions, normals: &mesh.normals, triangles: &mesh.triangles };
    let gbuffer = cpu::kernel_gbuffer(&triangles, &blocks, size);
    let mut sums = vec![Vec4::ZERO; gbuffer.entered.len()];
    for [rows, columns] in KernelTerm::of(kernel) {
        let between = cpu::blur_kernel(&rows, &domain, &gbuffer.entered);
        sums = cpu::sum_kernel(&columns, &domain, &between, &sums);
    }
    let reflections = cpu::Reflections { size: REFLECTION_SIZE, levels: scene.environment.reflections() };
    cpu::shade_kernel(&gbuffer, &sums, &KernelProfile::new(kernel), &blocks, &reflections, [BACKGROUND; 3])
}

/// A ball under two lights and a sky, of kernels of one term and of two, one of which is taken away; in half floats and in their bits.
fn balls(backend: Backend) {
    let gpus = [open(backend), open(backend).with_target_format(TargetFormat::Packed)];
    let (mesh, size) = (sphere(5.0, 24), [120, 90]);
    let far = Vec3::new(3.0, 4.0, 22.0);
    // Turned taps where the ball covers the picture: then the first texel of the maps is that of the picture.
    let cases = [
        ("skin", skin(17), far, false),
        ("difference", difference(11), far, false),
        ("skin, jittered", skin(17), 0.42 * far, true),
    ];
    for (name, model, eye_mm, jittered_taps) in cases {
        let scene = Scene {
            lights: vec![light(Vec3::new(0.9, 1.0, 0.3), [3.0, 2.8, 2.5]), light(Vec3::NEG_X, [0.2, 0.3, 0.6])],
            environment: Environment::uniform([0.2, 0.25, 0.3]),
            roughness: 0.3,
            camera: Camera { eye_mm, target_mm: Vec3::ZERO, fov_y_rad: 0.6, exposure: 0.5 },
        };
        let file = model.to_bytes().unwrap();
        let expected = by_twins(&Kernel::parse(&file).unwrap(), jittered_taps, &mesh, &scene, size);
        let covered = expected.iter().filter(|pixel| **pixel != [BACKGROUND; 3]).count();
        assert!(covered * 5 > expected.len(), "{name}: the ball is in the picture");
        for gpu in &gpus {
            let found = drawn(gpu, &[(&mesh, &file)], &scene, size, RuntimeOptions { jittered_taps, ..fine() });
            let (count, format) = (different(&found, &expected, KERNEL_TOLERANCE), gpu.target_format());
            println!("{backend}, {format:?}, {name}: {count} of {} pixels differ, {covered} are covered", found.len());
            assert!(count as f64 <= EDGE_PIXELS * found.len() as f64, "{backend}, {name}: {count} pixels differ");
        }
    }
}

#[test]
fn kernels_on_vulkan() {
    balls(Backend::Vulkan);
}

#[test]
fn kernels_on_gles_3_0() {
    balls(Backend::Gl);
}

/// Rectangle at z = 0, from `left` to `right`, 8 mm up and down, with one normal.
pub(super) fn rectangle(left: f32, right: f32, normal: Vec3) -> Mesh {
    let positions = [[left, -8.0], [right, -8.0], [right, 8.0], [left, 8.0]].map(|[x, y]| Vec3::new(x, y, 0.0));
    Mesh {
        positions: positions.to_vec(),
        normals: vec![normal; 4],
        uvs: None,
        sides: None,
        triangles: vec![[0, 1, 2], [0, 2, 3]],
    }
}

/// Two rectangles as one mesh.
pub(super) fn joined(a: &Mesh, b: &Mesh) -> Mesh {
    let first = u32::try_from(a.positions.len()).unwrap();
    let mut both = a.clone();
    both.positions.extend(&b.positions);
    both.normals.extend(&b.normals);
    both.triangles.extend(b.triangles.iter().map(|triangle| triangle.map(|k| k + first)));
    both
}

/// Irradiance of the lights of planes.
pub(super) const IRRADIANCE: f32 = 4.0;
/// Towards the light of all planes: 45° from the normal.
const ASLANT: Vec3 = Vec3::new(1.0, 0.0, 1.0);
/// Normal of what faces the eye, and of what the light only grazes.
pub(super) const NORMALS: [Vec3; 2] =
    [Vec3::Z, Vec3::new(-std::f32::consts::FRAC_1_SQRT_2, 0.0, std::f32::consts::FRAC_1_SQRT_2)];
pub(super) const PLANES: [u32; 2] = [120, 80];

/// Planes under one light, seen from afar, without a sky; `high` mm fit into the upper half of the picture.
pub(super) fn planes(high: f32) -> Scene {
    Scene {
        lights: vec![light(ASLANT, [IRRADIANCE; 3])],
        environment: Environment::uniform([0.0; 3]),
        roughness: 0.0,
        camera: Camera {
            eye_mm: Vec3::new(0.0, 0.0, 400.0),
            target_mm: Vec3::ZERO,
            fov_y_rad: 2.0 * (high / 400.0).atan(),
            exposure: 1.0,
        },
    }
}

/// Linear values of what is drawn of planes.
pub(super) fn linear() -> RuntimeOptions {
    RuntimeOptions { tone_mapping: false, ..fine() }
}

/// Value of an exitance of 1 times what enters under the light of [`planes`], on a surface of that normal.
fn value(model: &KernelModel, normal: Vec3) -> f32 {
    value_of(model, std::f32::consts::FRAC_1_SQRT_2, normal)
}

/// The same where a light as bright comes in by an angle of that cosine.
pub(super) fn value_of(model: &KernelModel, cosine: f32, normal: Vec3) -> f32 {
    let entered = cpu::fresnel_transmittance(cosine, model.eta) * cosine;
    let leaves = cpu::fresnel_transmittance(normal.z, model.eta) / (cpu::diffuse_transmittance(model.eta) * PI);
    IRRADIANCE * entered * leaves * 255.0
}

/// Under even light a plane is as bright as its reflectance says, up to its borders.
#[test]
fn planes_have_the_reflectance() {
    let mesh = rectangle(-10.0, 10.0, NORMALS[0]);
    for (backend, model) in
        Backend::ALL.into_iter().flat_map(|backend| [(backend, skin(17)), (backend, difference(11))])
    {
        let picture = drawn(&open(backend), &[(&mesh, &model.to_bytes().unwrap())], &planes(8.0), PLANES, linear());
        let expected = model.reflectance.map(|share| share * value(&model, NORMALS[0]));
        let mut covered = 0;
        for pixel in picture.iter().filter(|pixel| **pixel != [BACKGROUND; 3]) {
            assert!(
                (0..3).all(|c| (f32::from(pixel[c]) - expected[c]).abs() < 1.0),
                "{backend}: {pixel:?}, {expected:?}"
            );
            covered += 1;
        }
        assert!(covered > 7_000, "{covered} pixels");
    }
}

/// Beyond an edge of light there is what the profile has beyond it, integrated along the edge.
#[test]
fn edges_are_the_integral_of_the_profile() {
    let mesh = joined(&rectangle(-12.0, 0.0, NORMALS[0]), &rectangle(0.0, 12.0, NORMALS[1]));
    let model = skin(65);
    for backend in Backend::ALL {
        let picture = drawn(&open(backend), &[(&mesh, &model.to_bytes().unwrap())], &planes(2.0), PLANES, linear());
        let mut worst = 0.0_f32;
        for column in 0..PLANES[0] {
            let x = (column as f32 + 0.5 - 60.0) / 20.0;
            let pixel = picture[(40 * PLANES[0] + column) as usize];
            let beyond = share_beyond(SKIN, model.radius, x.abs());
            for c in 0..3 {
                let (share, normal) = if x < 0.0 { (1.0 - beyond[c], NORMALS[0]) } else { (beyond[c], NORMALS[1]) };
                let expected = share * model.reflectance[c] * value(&model, normal);
                let error = (f32::from(pixel[c]) - expected).abs() / (model.reflectance[c] * value(&model, normal));
                worst = worst.max(error);
            }
        }
        println!("{backend}: an edge differs by {worst:.4} of the light");
        assert!(worst < 0.03, "{backend}: {worst}");
    }
}

/// Light stays within its material, however close the next one is.
#[test]
fn materials_do_not_leak_into_each_other() {
    let [lit, dark] = [rectangle(-12.0, 0.0, NORMALS[0]), rectangle(0.0, 12.0, NORMALS[1])];
    let [first, second] = [skin(17), difference(11)].map(|model| model.to_bytes().unwrap());
    for backend in Backend::ALL {
        let picture = drawn(&open(backend), &[(&lit, &first), (&dark, &second)], &planes(8.0), PLANES, linear());
        let alone = drawn(&open(backend), &[(&lit, &first)], &planes(8.0), PLANES, linear());
        for row in 5..75 {
            let of = |picture: &[[u8; 3]], column: u32| picture[(row * PLANES[0] + column) as usize];
            for column in 5..115 {
                let (found, expected) = (of(&picture, column), of(&alone, column));
                let expected = if column < 60 { expected } else { [0; 3] };
                assert!(
                    (0..3).all(|c| found[c].abs_diff(expected[c]) <= 1),
                    "{backend}, {column}: {found:?}, {expected:?}"
                );
            }
        }
    }
}
