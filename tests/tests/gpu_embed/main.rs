//! An application's frame: objects of ours and a cube of its own in one depth buffer, one encoder and one submission, under
//! a projection whose middle is elsewhere, into linear light.

use glam::camera::rh::proj::directx::orthographic;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3, Vec4};
use subsurf_runtime::wgpu::{self, Backends, LoadOp, Operations, StoreOp};
use subsurf_runtime::{Input, Object, Target};
use subsurf_scene::{Environment, Lighting, Mapping, View};

#[path = "../../../runtime/examples/embed/application.rs"]
mod application;
mod host_map;
mod lights;
mod lost;
mod mistakes;
mod projection;
mod stage;

use application::{CUBE, CUBE_COLOUR};
use stage::{LEATHER_AT, RADIUS, SIZE, Stage, luminance, sun, sun_from};

/// Pixels at the outlines: meshes have flat facets, the rays of the test meet spheres.
const OUTLINE: f64 = 0.001;

/// What is in front at a pixel.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Front {
    Nothing,
    Cube,
    Jade,
    Leather,
}

/// Distance along a ray to a sphere.
fn to_sphere(eye: Vec3, along: Vec3, centre: Vec3) -> f32 {
    let (b, c) = ((eye - centre).dot(along), (eye - centre).length_squared() - RADIUS * RADIUS);
    let discriminant = b * b - c;
    if discriminant < 0.0 { f32::INFINITY } else { -b - discriminant.sqrt() }
}

/// Distance along a ray to the cube.
fn to_cube(eye: Vec3, along: Vec3) -> f32 {
    let (middle, half) = CUBE;
    let (a, b) = ((middle - half - eye) / along, (middle + half - eye) / along);
    let (near, far) = (a.min(b).max_element(), a.max(b).min_element());
    if near <= far { near } else { f32::INFINITY }
}

/// What a ray through every pixel meets first.
fn expected(view: &View) -> Vec<Front> {
    let world_from_clip = view.clip_from_world().inverse();
    let pixels = (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| [x, y]));
    let ray = |[x, y]: [u32; 2]| {
        let ndc = [(x as f32 + 0.5) / SIZE[0] as f32 * 2.0 - 1.0, 1.0 - (y as f32 + 0.5) / SIZE[1] as f32 * 2.0];
        // Depth is 1 at the near plane, 0 far away.
        let at = |depth| (world_from_clip * Vec4::new(ndc[0], ndc[1], depth, 1.0)).project();
        (at(1.0), (at(0.01) - at(1.0)).normalize())
    };
    let front = |(eye, along): (Vec3, Vec3)| {
        let distances = [
            (to_cube(eye, along), Front::Cube),
            (to_sphere(eye, along, Vec3::ZERO), Front::Jade),
            (to_sphere(eye, along, LEATHER_AT), Front::Leather),
        ];
        let nearest = distances.into_iter().min_by(|(a, _), (b, _)| a.total_cmp(b)).unwrap();
        if nearest.0.is_finite() { nearest.1 } else { Front::Nothing }
    };
    pixels.map(ray).map(front).collect()
}

fn who_is_in_front(backends: Backends) {
    let stage = Stage::open(backends);
    let view = application::view();
    let objects = [stage.jade(), stage.leather()];
    // Light from all around only: objects without shadows look the same wherever the others are.
    let [all, jade, leather] =
        [&objects[..], &objects[..1], &objects[1..]].map(|objects| stage.draw(view, objects, &[], true));
    let found = (0..all.len()).map(|k| match all[k] {
        [_, _, _, 0.0] => Front::Nothing,
        [r, g, b, _] if [r, g, b] == CUBE_COLOUR => Front::Cube,
        pixel if pixel == jade[k] => Front::Jade,
        pixel if pixel == leather[k] => Front::Leather,
        other => panic!("pixel {k} is {other:?}, of no object alone"),
    });
    let (expected, found) = (expected(&view), found.collect::<Vec<_>>());
    for front in [Front::Nothing, Front::Cube, Front::Jade, Front::Leather] {
        let count = found.iter().filter(|found| **found == front).count();
        println!("{backends:?}: {front:?} in {count} pixels");
        assert!(100 * count > 2 * found.len(), "{front:?} is in {count} pixels");
    }
    let other = expected.iter().zip(&found).filter(|(a, b)| a != b).count();
    println!("{backends:?}: {other} of {} pixels differ from the rays", found.len());
    assert!((other as f64) < OUTLINE * found.len() as f64, "{other} pixels show another object");
}

#[test]
fn depth_is_shared_on_vulkan() {
    who_is_in_front(Backends::VULKAN);
}

#[test]
fn depth_is_shared_on_gles_3_0() {
    who_is_in_front(Backends::GL);
}

/// A mesh that is drawn elsewhere, turned, under a camera and a light that moved along, looks the same.
#[test]
fn transforms_move_objects_with_their_material() {
    let stage = Stage::open(Backends::VULKAN);
    let moved = Mat4::from_translation(Vec3::new(300.0, -50.0, 120.0)) * Mat4::from_rotation_y(0.7);
    let view = application::view();
    let along = View { view_from_world: view.view_from_world * moved.inverse(), ..view };
    let towards = moved.transform_vector3(Vec3::new(-1.0, 0.6, 0.5));
    let turned = sun_from(towards);
    for material in [&stage.jade, &stage.splats] {
        let object = Object { material, ..stage.jade() };
        let here = stage.draw(view, &[object], &[sun()], false);
        let there = stage.draw(along, &[Object { world_from_mesh: moved, ..object }], &[turned], false);
        let worst = |a: &[f32; 4], b: &[f32; 4]| (0..4).map(|c| (a[c] - b[c]).abs()).fold(0.0, f32::max);
        let far = here.iter().zip(&there).filter(|(a, b)| worst(a, b) > 0.03).count();
        println!("{:?}: {far} of {} pixels differ", material.technique(), here.len());
        assert!(luminance(&here) > 1e3, "it is in the picture");
        assert!(far * 100 < here.len(), "{far} pixels differ");
    }
}

/// An object's shadow falls on another one; light that enters one does not leave from another.
#[test]
fn objects_shadow_each_other() {
    let stage = Stage::open(Backends::VULKAN);
    let between = Mat4::from_translation(Vec3::new(-14.0, 8.4, 7.0));
    let view = application::view();
    let blocker = Object { world_from_mesh: between, ..stage.leather() };
    let lit = stage.draw(view, &[stage.leather()], &[sun()], false);
    let alone = stage.draw(view, &[stage.jade()], &[sun()], false);
    let shadowed = stage.draw(view, &[stage.jade(), blocker], &[sun()], false);
    let hidden = stage.draw(view, &[blocker], &[], false);
    let middle = |pixels: &[[f32; 4]]| {
        // Where the jade is and the leather is not.
        let covered = pixels.iter().zip(&alone).zip(&hidden);
        let covered = covered.filter(|((_, alone), hidden)| alone[3] > 0.0 && hidden[3] == 0.0);
        luminance(&covered.map(|((pixel, _), _)| *pixel).collect::<Vec<_>>())
    };
    assert!(luminance(&lit) > 1e3, "the leather is lit");
    let (alone, shadowed) = (middle(&alone), middle(&shadowed));
    println!("light of the jade alone: {alone}, in the shadow: {shadowed}");
    assert!(shadowed < 0.75 * alone, "{shadowed} of {alone}");
}

/// What the camera does not see casts its shadow all the same.
#[test]
fn objects_out_of_view_cast_shadows() {
    let stage = Stage::open(Backends::VULKAN);
    let view = application::view();
    // Along the light, far above the picture.
    let towards = Vec3::new(-0.2, 1.0, 0.1).normalize();
    let light = sun_from(towards);
    let blocker = Object { world_from_mesh: Mat4::from_translation(45.0 * towards), ..stage.leather() };
    let [alone, hidden, shadowed] = [&[stage.jade()][..], &[blocker], &[stage.jade(), blocker]]
        .map(|objects| stage.draw(view, objects, &[light], false));
    assert!(hidden.iter().all(|pixel| pixel[3] == 0.0), "the blocker is out of view");
    let (alone, shadowed) = (luminance(&alone), luminance(&shadowed));
    println!("light of the jade alone: {alone}, in the shadow: {shadowed}");
    assert!(shadowed < 0.6 * alone, "{shadowed} of {alone}");
}

/// A part of a target shows what a whole one of that size does.
#[test]
fn parts_of_a_target_are_pictures() {
    let stage = Stage::open(Backends::VULKAN);
    let (size, origin) = ([160, 120], [100, 50]);
    for material in [&stage.jade, &stage.splats] {
        let objects = [Object { material, ..stage.jade() }, stage.leather()];
        let draw = |origin| stage.draw_part(application::view(), &objects, &[sun()], false, [origin, size]);
        let (corner, middle) = (draw([0; 2]), draw(origin));
        let at = |x: u32, y: u32| (y * SIZE[0] + x) as usize;
        let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| [x, y]));
        let far = pixels.filter(|[x, y]| {
            let (a, b) = (corner[at(*x, *y)], middle[at(x + origin[0], y + origin[1])]);
            (0..4).any(|c| (a[c] - b[c]).abs() > 0.02)
        });
        let (far, covered) = (far.count(), middle.iter().filter(|pixel| pixel[3] > 0.0).count());
        println!("{:?}: {far} pixels differ, {covered} are covered", material.technique());
        assert!(covered > 2_000, "{covered} pixels are covered");
        assert!(200 * far < covered, "{far} of {covered} pixels differ");
    }
}

/// Parallel lines of sight are those of a camera far away.
#[test]
fn parallel_projection_is_that_of_a_camera_far_away() {
    let stage = Stage::open(Backends::VULKAN);
    let (along, half, far_mm) = (Vec3::new(0.4, 0.3, 1.0).normalize(), Vec3::new(16.0, 12.0, 0.0), 20_000.0);
    let view_from_world = |distance: f32| look_at_mat4(distance * along, Vec3::ZERO, Vec3::Y);
    // Reversed: the near plane is 1.
    let parallel = orthographic(-half.x, half.x, -half.y, half.y, 200.0, 20.0);
    let parallel = View { view_from_world: view_from_world(100.0), clip_from_view: parallel };
    let perspective = Mat4::from_cols(
        Vec4::new(far_mm / half.x, 0.0, 0.0, 0.0),
        Vec4::new(0.0, far_mm / half.y, 0.0, 0.0),
        Vec4::new(0.0, 0.0, 0.0, -1.0),
        Vec4::new(0.0, 0.0, far_mm - 50.0, 0.0),
    );
    let perspective = View { view_from_world: view_from_world(far_mm), clip_from_view: perspective };
    for material in [&stage.jade, &stage.splats, &stage.leather] {
        let object = Object { material, mapping: Mapping::Uv([2.0, 1.0]), ..stage.jade() };
        let [near, far] = [parallel, perspective].map(|view| stage.draw(view, &[object], &[sun()], false));
        let covered = near.iter().filter(|pixel| pixel[3] > 0.0).count();
        let differs = |(a, b): &(&[f32; 4], &[f32; 4])| (0..4).any(|c| (a[c] - b[c]).abs() > 0.05);
        let other = near.iter().zip(&far).filter(differs).count();
        println!("{:?}: {other} of {covered} pixels differ", material.technique());
        assert!(covered > 10_000, "{covered} pixels are covered");
        assert!(50 * other < covered, "{other} of {covered} pixels differ");
    }
}

/// Objects come and go with every frame, and leave nothing behind, by the ledger and by wgpu's allocator.
#[test]
fn objects_come_and_go() {
    let stage = Stage::open(Backends::VULKAN);
    let environment = Environment::uniform([0.35, 0.4, 0.5]);
    let lights = [sun()];
    let lighting = Lighting { lights: &lights, environment: &environment, reference_mm: Vec3::ZERO };
    let all = [stage.jade(), stage.leather(), Object { material: &stage.splats, ..stage.jade() }];
    let whole = Input { view: application::view(), exposure: 1.0, lighting, shadow_maps: &[], objects: &all };
    let size = [32, 24];
    let mut frame = stage.renderer.prepare(&stage.gpu, &whole, size).unwrap();
    let view = stage.app.colour.create_view(&wgpu::TextureViewDescriptor::default());
    let allocated = || stage.app.device.generate_allocator_report().map_or(0, |report| report.total_allocated_bytes);
    let mut after_some = (0, 0);
    for number in 0..1_000_usize {
        let out_of_view = Mat4::from_translation(Vec3::new(0.0, 900.0, 0.0));
        let mut objects = all;
        objects.rotate_left(number % 3);
        objects[2].world_from_mesh = out_of_view;
        let input = Input { objects: &objects[number % 4 % 3..], ..whole };
        let mut encoder = stage.app.device.create_command_encoder(&Default::default());
        let cleared = Operations { load: LoadOp::Clear(0.0), store: StoreOp::Store };
        let target = Target { depth_ops: cleared, ..stage.over(&view) };
        stage.renderer.draw(&stage.gpu, &mut encoder, &mut frame, &input, &target).unwrap();
        let commands = encoder.finish();
        // Recording is what is looked at; drawing a tenth of it is enough.
        if number % 10 == 0 {
            stage.app.queue.submit([commands]);
            stage.gpu.finish().unwrap();
        }
        if number == 100 {
            after_some = (stage.gpu.ledger().bytes(), allocated());
        }
    }
    stage.gpu.finish().unwrap();
    println!("{after_some:?} bytes after 100 frames, {} after 1000", allocated());
    assert_eq!(stage.gpu.ledger().bytes(), after_some.0, "by the ledger");
    assert!(allocated() <= after_some.1 + (1 << 20), "{} after {after_some:?}", allocated());
}
