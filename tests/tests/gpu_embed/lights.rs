//! Many lights, with shadows and without, and the host's own shadow maps.

use glam::camera::rh::proj::directx::orthographic;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3, Vec4};
use subsurf_runtime::wgpu::{Backends, TextureFormat};
use subsurf_runtime::{Input, Object, RuntimeOptions, ShadowMap};
use subsurf_scene::{Environment, Light, LightShape, Lighting, MAX_LIGHTS, Shadow};

use super::application;
use super::host_map::HostMap;
use super::stage::{RADIUS, Stage, luminance, sun_from};

/// Pixels of the pictures.
const SIZE: [u32; 2] = [160, 120];

/// Linear light of some objects under some lights alone.
fn draw(stage: &Stage, objects: &[Object<'_>], lights: &[Light], shadow_maps: &[ShadowMap<'_>]) -> Vec<[f32; 4]> {
    let environment = Environment::uniform([0.0; 3]);
    let lighting = Lighting { lights, environment: &environment, reference_mm: Vec3::ZERO };
    let input = Input { view: application::view(), exposure: 1.0, lighting, shadow_maps, objects };
    stage.draw_input(&input, false, [[0; 2], SIZE])
}

/// The same sphere of materials of all techniques that frames draw.
fn all(stage: &Stage) -> [Object<'_>; 3] {
    let leather = Object { world_from_mesh: Mat4::IDENTITY, ..stage.leather() };
    [stage.jade(), Object { material: &stage.splats, ..stage.jade() }, leather]
}

/// Eight lights of all kinds; every third without a shadow, if some are.
fn eight(have_all_shadows: bool) -> [Light; MAX_LIGHTS] {
    std::array::from_fn(|k| {
        let turn = k as f32 * 0.8;
        let towards = Vec3::new(turn.cos(), 0.4, 0.5 + turn.sin());
        let shape = match k % 3 {
            0 => LightShape::Directional { towards },
            1 => LightShape::Point { position_mm: 50.0 * towards.normalize() },
            _ => {
                LightShape::Spot { position_mm: 60.0 * towards.normalize(), target_mm: Vec3::ZERO, half_angle_rad: 0.3 }
            }
        };
        let shadow = if k % 3 == 2 && !have_all_shadows { Shadow::None } else { Shadow::Drawn };
        Light { shape, irradiance: [1.0, 0.2 * turn, 1.5 - 0.1 * turn], shadow }
    })
}

/// Largest error of light of all lights together against their sum, of one in a thousand pixels more: half floats are rounded
/// pass by pass, and splats lose up to 2⁻¹¹ with each of the many additions to a texel.
const SUM_ERRORS: [f32; 3] = [0.004, 0.04, 0.004];

/// Textures of the application have 2,048 texels to a side: six views of 512 lie in two rows, and eight.
///
/// Only where all shadows are drawn do wide Gaussians spread in a light volume: a faint light sees to it that those of one frame
/// and of many are drawn in the same way.
fn lights_add_up(backends: Backends, light_texels: u32) {
    let stage = Stage::with(backends, RuntimeOptions { light_texels, ..RuntimeOptions::default() });
    let cases = all(&stage).into_iter().zip(SUM_ERRORS).map(|case| (case, false));
    for ((object, limit), have_all_shadows) in cases.chain([((stage.jade(), SUM_ERRORS[0]), true)]) {
        let eight = eight(have_all_shadows);
        let faint = Light { irradiance: [1e-6; 3], shadow: Shadow::None, ..eight[0] };
        let together = draw(&stage, &[object], &eight, &[]);
        let mut sum = vec![[0.0; 3]; together.len()];
        for light in eight {
            let lights = [light, faint];
            let alone = if have_all_shadows { &lights[..1] } else { &lights };
            for (sum, pixel) in sum.iter_mut().zip(draw(&stage, &[object], alone, &[])) {
                *sum = [0, 1, 2].map(|c| sum[c] + pixel[c]);
            }
        }
        let covered = together.iter().zip(&sum).filter(|(pixel, _)| pixel[3] > 0.0);
        let error =
            |(a, b): (&[f32; 4], &[f32; 3])| (0..3).map(|c| (a[c] - b[c]).abs() / b[c].max(0.1)).fold(0.0, f32::max);
        let mut errors: Vec<f32> = covered.map(error).collect();
        errors.sort_by(f32::total_cmp);
        let most = errors[errors.len() * 999 / 1000];
        println!("{backends:?}, {:?}: {most} of {} pixels", object.material.technique(), errors.len());
        assert!(errors.len() > 1_000, "{} pixels are covered", errors.len());
        assert!(most < limit, "{:?}: {most}", object.material.technique());
    }
}

#[test]
fn eight_lights_are_the_sum_of_each_on_vulkan() {
    lights_add_up(Backends::VULKAN, 512);
}

#[test]
fn eight_lights_are_the_sum_of_each_on_gles_3_0() {
    lights_add_up(Backends::GL, 128);
}

/// Out of the picture, between the light and everything.
fn blocker<'a>(stage: &'a Stage, towards: Vec3) -> Object<'a> {
    Object { world_from_mesh: Mat4::from_translation(45.0 * towards), ..stage.leather() }
}

fn lights_without_shadows(backends: Backends) {
    let stage = Stage::open(backends);
    let towards = Vec3::new(-0.2, 1.0, 0.1).normalize();
    for object in all(&stage) {
        let of = |shadow, objects: &[Object<'_>]| {
            luminance(&draw(&stage, objects, &[Light { shadow, ..sun_from(towards) }], &[]))
        };
        let both = [object, blocker(&stage, towards)];
        let [free, through, hidden, alone] = [
            of(Shadow::None, &both[..1]),
            of(Shadow::None, &both),
            of(Shadow::Drawn, &both),
            of(Shadow::Drawn, &both[..1]),
        ];
        println!("{backends:?}, {:?}: {free} {through} {hidden} {alone}", object.material.technique());
        assert!((through / free - 1.0).abs() < 0.01, "{through} through the blocker, {free} without it");
        assert!(hidden < 0.5 * alone, "{hidden} behind the blocker, {alone} without it");
        // What faces the light is lit alike; the sphere shades no other part of itself.
        assert!((free / alone - 1.0).abs() < 0.1, "{free} without shadows, {alone} with them");
    }
}

#[test]
fn lights_without_shadows_shine_through_on_vulkan() {
    lights_without_shadows(Backends::VULKAN);
}

#[test]
fn lights_without_shadows_shine_through_on_gles_3_0() {
    lights_without_shadows(Backends::GL);
}

/// Light of a picture, and the share of its pixels that differ from another one.
fn compare(found: &[[f32; 4]], other: &[[f32; 4]]) -> (f64, f64) {
    let differs = |(a, b): &(&[f32; 4], &[f32; 4])| (0..3).any(|c| (a[c] - b[c]).abs() > 0.05);
    let covered = other.iter().filter(|pixel| pixel[3] > 0.0).count();
    assert!(covered > 1_000, "{covered} pixels are covered");
    let share = found.iter().zip(other).filter(differs).count() as f64 / covered as f64;
    (luminance(found) / luminance(other), share)
}

/// Maps of the host's against our own: of a light from afar and of a spot, in which a sphere shades another, and of a light from
/// behind, which comes through where a sphere is thin. Edges of shadows differ, for the texels of the maps lie elsewhere.
fn host_maps(backends: Backends) {
    let stage = Stage::with(backends, RuntimeOptions { host_shadow_maps: true, ..RuntimeOptions::default() });
    let (front, back) = (Vec3::new(-1.0, 0.6, 0.5).normalize(), Vec3::new(0.3, 0.5, -1.0).normalize());
    let from = |eye_mm: Vec3| look_at_mat4(eye_mm, Vec3::ZERO, Vec3::Y);
    let parallel = orthographic(-30.0, 30.0, -30.0, 30.0, 10.0, 130.0);
    // Reversed, without a far plane.
    let endless = Mat4::from_cols(2.0 * Vec4::X, 2.0 * Vec4::Y, -Vec4::W, 20.0 * Vec4::Z);
    let spot = LightShape::Spot { position_mm: 70.0 * front, target_mm: Vec3::ZERO, half_angle_rad: 0.5 };
    let spot = Light { shape: spot, ..sun_from(front) };
    let between = 18.0 * front + 5.0 * Vec3::X;
    let blocker = Object { world_from_mesh: Mat4::from_translation(between), ..stage.leather() };
    let drawn = |light: Light, to: Mat4, (format, is_reversed), objects: &[Object<'_>]| {
        let centres: Vec<Vec3> = objects.iter().map(|object| object.world_from_mesh.w_axis.truncate()).collect();
        let map = HostMap::draw(&stage.app, RADIUS, &centres, to, format, is_reversed);
        let maps = [ShadowMap { depth: map.view(), clip_from_world: to, is_reversed }];
        let found = draw(&stage, objects, &[Light { shadow: Shadow::Host(0), ..light }], &maps);
        (found, draw(&stage, objects, &[light], &[]))
    };
    for (name, light, to, kind) in [
        ("sun", sun_from(front), parallel * from(70.0 * front), (TextureFormat::Depth16Unorm, false)),
        ("spot", spot, endless * from(70.0 * front), (TextureFormat::Depth32Float, true)),
    ] {
        let (found, ours) = drawn(light, to, kind, &[stage.jade(), blocker]);
        let (light, share) = compare(&found, &ours);
        println!("{backends:?}, {name}: {share} of pixels differ, {light} of the light");
        assert!(share < 0.02 && (light - 1.0).abs() < 0.03, "{name}: {share} {light}");
    }
    let kind = (TextureFormat::Depth24Plus, false);
    let (found, ours) = drawn(sun_from(back), parallel * from(70.0 * back), kind, &[stage.jade()]);
    let (light, share) = compare(&found, &ours);
    println!("{backends:?}, from behind: {share} of pixels differ, {light} of the light");
    assert!(share < 0.02 && (light - 1.0).abs() < 0.1, "from behind: {share} {light}");
    // Splats have no samples of the light, and its shadow all the same.
    let splats = Object { material: &stage.splats, ..stage.jade() };
    let to = parallel * from(70.0 * front);
    let [alone, shaded] = [&[splats][..], &[splats, blocker]].map(|objects| drawn(sun_from(front), to, kind, objects));
    let (open, _) = compare(&alone.0, &alone.1);
    let (light, _) = compare(&shaded.0, &shaded.1);
    println!("{backends:?}, splats: {open} of the light, {light} in the shadow");
    assert!((open - 1.0).abs() < 0.1 && (light - 1.0).abs() < 0.1, "splats: {open} {light}");
}

#[test]
fn maps_of_the_host_shade_as_ours_on_vulkan() {
    host_maps(Backends::VULKAN);
}

#[test]
fn maps_of_the_host_shade_as_ours_on_gles_3_0() {
    host_maps(Backends::GL);
}
