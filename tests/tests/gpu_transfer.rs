//! Meshes whose scattering is precomputed: against their twin, and against sums over their lights.

use glam::{Mat4, Quat, Vec3};
use subsurf_decoder::transfer::LightWeights;
use subsurf_decoder::{File, Transfer};
use subsurf_encoder::kernel::Profile;
use subsurf_encoder::metrics::transfer::decode;
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::transfer::{Options, RdTable, Size, encode, fibonacci, precompute};
use subsurf_runtime::{
    BACKGROUND, Backend, Error, Gpu, GpuMesh, Input, Material, Object, PictureTarget, Renderer, RuntimeOptions,
    TargetFormat, Technique, VertexData,
};
use subsurf_scene::{
    Camera, Environment, Light, LightShape, Mapping, Mesh, Placement, REFLECTION_SIZE, Scene, Shadow, knot,
};
use subsurf_shaders::cpu;
use subsurf_shaders::uniform::Blocks;
use subsurf_tests::frames::device;

const SIZE: [u32; 2] = [160, 120];
/// Steps of 255 between device and twin: one for rounding, one for another order of sums.
const TOLERANCE: u8 = 2;
/// Share of the pixels that may differ more: on edges drivers and the twin choose one triangle or the other.
const EDGE_PIXELS: f64 = 0.004;

/// A knot of few vertices, which shades itself.
fn mesh() -> Mesh {
    knot(10.0, 3.0, 20).fitted(20.0).unwrap()
}

/// What is precomputed for a mesh of marble.
fn precomputed(mesh: &Mesh, channels: usize, size: &Size) -> Vec<u8> {
    let profile = Profile::dipole(&Medium::measured("marble").unwrap(), 1.5).unwrap();
    let (table, lights) = (RdTable::of(&profile).unwrap(), fibonacci(40));
    let of = precompute(mesh, &table, &lights, &Options { channels, eta: 1.5 }, &()).unwrap();
    encode(mesh, &table, &of, 1.5, size, &()).unwrap()
}

/// Six bytes for a vertex, and a texel.
const SMALL: Size = Size { clusters: 5, components: 8, bits: 40 };
/// Sixteen, and two, of codes that begin anywhere in their words.
const LARGE: Size = Size { clusters: 3, components: 11, bits: 119 };

fn light(shape: LightShape, irradiance: [f32; 3]) -> Light {
    Light { shape, irradiance, shadow: Shadow::None }
}

/// Eight lights of different colours, from afar, from a point and in a cone.
fn lights() -> Vec<Light> {
    let far = (0..6_u8).map(|k| {
        let angle = f32::from(k);
        let towards = Vec3::new(angle.cos(), 0.6 - 0.3 * angle, angle.sin());
        light(LightShape::Directional { towards }, [0.2 + 0.15 * angle, 0.6, 1.2 - 0.2 * angle])
    });
    let near = [
        light(LightShape::Point { position_mm: Vec3::new(30.0, 40.0, 50.0) }, [0.5, 0.3, 0.4]),
        light(
            LightShape::Spot { position_mm: Vec3::new(-50.0, 20.0, 30.0), target_mm: Vec3::ZERO, half_angle_rad: 0.6 },
            [0.1, 0.9, 0.2],
        ),
    ];
    far.chain(near).collect()
}

fn scene(lights: Vec<Light>, environment: Environment) -> Scene {
    Scene {
        lights,
        environment,
        roughness: 0.3,
        camera: Camera { eye_mm: Vec3::new(12.0, 10.0, 39.0), target_mm: Vec3::ZERO, fov_y_rad: 0.5, exposure: 0.4 },
    }
}

/// Draws a mesh that a file is of.
fn drawn(gpu: &Gpu, mesh: &Mesh, file: &[u8], scene: &Scene, world_from_mesh: Mat4) -> Vec<[u8; 3]> {
    let options = RuntimeOptions::default();
    let renderer = Renderer::for_technique(gpu, Technique::Transfer, options).unwrap();
    let material = Material::load(gpu, &File::parse(file).unwrap()).unwrap();
    let mesh = GpuMesh::upload(gpu, mesh, VertexData::default()).unwrap();
    let objects = [Object { world_from_mesh, ..Object::new(&mesh, &material, Mapping::Box, scene.roughness) }];
    let input = Input::new(scene, &objects, SIZE);
    let mut frame = renderer.prepare(gpu, &input, SIZE).unwrap();
    let target = PictureTarget::new(gpu, SIZE, &options).unwrap();
    renderer.picture(gpu, &mut frame, &input, &target).unwrap()
}

/// The same by the twin.
fn by_twin(mesh: &Mesh, file: &[u8], scene: &Scene) -> Vec<[u8; 3]> {
    let transfer = Transfer::parse(file).unwrap();
    let placement = Placement::of_homogeneous_within(mesh.bounding_sphere(), transfer.header().eta);
    let blocks = Blocks::new(scene, &placement, SIZE, 512);
    let triangles = cpu::KernelMesh { positions: &mesh.positions, normals: &mesh.normals, triangles: &mesh.triangles };
    let reflections = cpu::Reflections { size: REFLECTION_SIZE, levels: scene.environment.reflections() };
    cpu::shade_transfer(&transfer, &triangles, &blocks, &reflections, SIZE, [BACKGROUND; 3])
}

/// Pixels that differ by more than the tolerance.
fn different(a: &[[u8; 3]], b: &[[u8; 3]]) -> usize {
    let far = |(a, b): &(&[u8; 3], &[u8; 3])| (0..3).any(|c| a[c].abs_diff(b[c]) > TOLERANCE);
    assert_eq!(a.len(), b.len(), "pixels");
    a.iter().zip(b).filter(far).count()
}

fn is_as_the_twin(backend: Backend) {
    let mesh = mesh();
    let gpu = device(backend);
    if backend == Backend::Gl && gpu.info().driver_info.contains("Mesa") {
        assert!(gpu.info().driver_info.starts_with("OpenGL ES 3.0"), "not forced to 3.0: {}", gpu.info().driver_info);
    }
    let gpus = [gpu, device(backend).with_target_format(TargetFormat::Packed)];
    let scene = scene(lights(), Environment::studio());
    for (channels, size) in [(3, SMALL), (1, LARGE)] {
        let file = precomputed(&mesh, channels, &size);
        let expected = by_twin(&mesh, &file, &scene);
        let covered = expected.iter().filter(|pixel| **pixel != [BACKGROUND; 3]).count();
        assert!(covered * 5 > expected.len(), "the knot is in the picture: {covered}");
        for gpu in &gpus {
            let found = drawn(gpu, &mesh, &file, &scene, Mat4::IDENTITY);
            let (count, format) = (different(&found, &expected), gpu.target_format());
            println!("{backend}, {format:?}, {channels}: {count} of {} differ, {covered} are covered", found.len());
            assert!(count as f64 <= EDGE_PIXELS * found.len() as f64, "{backend}, {channels}: {count} pixels differ");
        }
    }
}

#[test]
fn pictures_are_those_of_the_twin_on_vulkan() {
    is_as_the_twin(Backend::Vulkan);
}

#[test]
fn pictures_are_those_of_the_twin_on_gles_3_0() {
    is_as_the_twin(Backend::Gl);
}

/// Exitance under all lights at once is the sum of what the decoder gives for each alone, by its own table.
#[test]
fn many_lights_are_the_sum_of_each() {
    let mesh = mesh();
    let file = precomputed(&mesh, 3, &SMALL);
    let transfer = Transfer::parse(&file).unwrap();
    let environment = Environment::uniform([0.3, 0.2, 0.1]);
    let reflections = cpu::Reflections { size: REFLECTION_SIZE, levels: environment.reflections() };
    let placement = Placement::of_homogeneous_within(mesh.bounding_sphere(), 1.5);
    let scene = scene(lights().into_iter().take(6).collect(), environment.clone());
    let blocks = Blocks::new(&scene, &placement, SIZE, 512);
    let turn = Quat::from_euler(glam::EulerRot::YXZ, 0.5, 0.3, -0.8);
    let light = subsurf_shaders::TransferLight::new(
        transfer.lights(),
        &blocks.scene,
        &Mat4::from_quat(turn),
        Vec3::ZERO,
        &reflections,
    );
    let found = cpu::transfer_exitance(&transfer, &light);

    let lights = usize::from(transfer.header().lights);
    let mut buffer = vec![0.0; LightWeights::buffer_len(lights)];
    let between = LightWeights::new(transfer.lights(), &mut buffer).unwrap();
    let mut expected = vec![Vec3::ZERO; mesh.positions.len()];
    let mut add = |weights: &[f32], colour: Vec3| {
        for (sum, q) in expected.iter_mut().zip(decode(&transfer, weights).as_chunks().0) {
            *sum += colour * Vec3::from_array(*q);
        }
    };
    for source in &scene.lights {
        let LightShape::Directional { towards } = source.shape else { panic!("lights from afar") };
        let mut weights = vec![0.0; lights];
        between.at((turn.inverse() * towards.normalize()).into(), &mut weights);
        add(&weights, source.irradiance.into());
    }
    // Even light from everywhere: each light of the file has its share of 4π times the radiance.
    add(&vec![4.0 / lights as f32; lights], Vec3::new(0.3, 0.2, 0.1));
    let largest = expected.iter().fold(0.0, |most: f32, rgb| most.max(rgb.max_element()));
    for (found, expected) in found.iter().zip(&expected) {
        let error = (Vec3::from(*found) - expected.max(Vec3::ZERO)).abs().max_element();
        assert!(error < 1e-5 * largest, "{found:?}, {expected}");
    }
}

/// Light that turns with the mesh leaves the same.
#[test]
fn a_mesh_that_turns_takes_its_lights_along() {
    let mesh = mesh();
    let file = precomputed(&mesh, 1, &SMALL);
    let turn = Quat::from_rotation_y(1.1) * Quat::from_rotation_x(0.4);
    let first = lights().swap_remove(1);
    let LightShape::Directional { towards } = first.shape else { panic!("a light from afar") };
    let still = scene(vec![first], Environment::uniform([0.3; 3]));
    let mut turned = still.clone();
    turned.lights[0].shape = LightShape::Directional { towards: turn * towards };
    turned.camera.eye_mm = turn * still.camera.eye_mm;
    for backend in Backend::ALL {
        let gpu = device(backend);
        let centre = mesh.bounding_sphere().centre_mm;
        // About the centre, so that the camera of both is as far from it.
        let world = Mat4::from_translation(centre) * Mat4::from_quat(turn) * Mat4::from_translation(-centre);
        let [a, b] = [(&still, Mat4::IDENTITY), (&turned, world)].map(|(scene, world)| {
            let picture = drawn(&gpu, &mesh, &file, scene, world);
            let sum = |c: usize| picture.iter().map(|pixel| f64::from(pixel[c])).sum::<f64>();
            (0..3).map(sum).collect::<Vec<f64>>()
        });
        // Another way up of the camera covers a few other pixels.
        for c in 0..3 {
            assert!((a[c] - b[c]).abs() < 0.01 * a[c], "{backend}: {a:?}, {b:?}");
        }
    }
}

/// A file is drawn on the mesh that it is of, and on no other, by one object in its own size.
#[test]
fn other_meshes_are_refused() {
    let right = mesh();
    let file = precomputed(&right, 1, &SMALL);
    let gpu = device(Backend::Vulkan);
    let renderer = Renderer::for_technique(&gpu, Technique::Transfer, RuntimeOptions::default()).unwrap();
    let material = Material::load(&gpu, &File::parse(&file).unwrap()).unwrap();
    let scene = scene(lights(), Environment::uniform([0.1; 3]));
    let upload = |mesh: &Mesh| GpuMesh::upload(&gpu, mesh, VertexData::default()).unwrap();
    let mut turned = right.clone();
    turned.triangles[0].rotate_left(1);
    let others = [(right.clone().fitted(21.0).unwrap(), "in another size or place"), (turned, "another mesh")];
    for (other, why) in others {
        let other = upload(&other);
        let objects = [Object::new(&other, &material, Mapping::Box, 0.3)];
        match renderer.prepare(&gpu, &Input::new(&scene, &objects, SIZE), SIZE) {
            Err(Error::Mesh(reason)) => assert!(reason.contains(why), "{reason}"),
            other => panic!("{:?}", other.map(|_| "a frame")),
        }
    }
    let own = upload(&right);
    let object = Object::new(&own, &material, Mapping::Box, 0.3);
    let larger = Object { world_from_mesh: Mat4::from_scale(Vec3::splat(2.0)), ..object };
    for objects in [vec![object, object], vec![larger]] {
        let input = Input::new(&scene, &objects, SIZE);
        let mut frame = renderer.prepare(&gpu, &input, SIZE).unwrap();
        let target = PictureTarget::new(&gpu, SIZE, renderer.options()).unwrap();
        let result = renderer.picture(&gpu, &mut frame, &input, &target);
        assert!(matches!(result, Err(Error::Usage(_))), "{result:?}");
    }
}
