//! Light through plates of homogeneous materials, under lights with drawn shadows: against closed forms.

use glam::Vec3;
use subsurf_encoder::kernel::{Kernel as KernelModel, TwoGaussians};
use subsurf_runtime::Backend;
use subsurf_scene::{Light, Mesh, Scene, Shadow};
use subsurf_tests::kernels::{SKIN, WIDE, difference, share_through, skin};

use super::kernel::{IRRADIANCE, NORMALS, PLANES, drawn, joined, light, linear, planes, rectangle, value_of};
use super::open;

/// Display values: targets of half floats, and T between its nodes.
const TOLERANCE: f32 = 1.5;
/// Left ends of plates 8 mm wide, and their thickness in mm.
const PLATES: [(f32, f32); 3] = [(-12.0, 0.4), (-4.0, 0.9), (4.0, 2.0)];
/// Columns of the picture in the middle of the plates: 5 to a mm.
const COLUMNS: [u32; 3] = [20, 60, 100];

/// A plate whose front is at a depth `behind` z = 0.
fn plate(left: f32, right: f32, behind: f32, thickness: f32) -> Mesh {
    let shifted = |normal: Vec3, z: f32| {
        let mut side = rectangle(left, right, normal);
        side.positions.iter_mut().for_each(|position| position.z = z);
        side
    };
    joined(&shifted(Vec3::Z, -behind), &shifted(Vec3::NEG_Z, -behind - thickness))
}

fn with_shadow(towards: Vec3) -> Light {
    Light { shadow: Shadow::Drawn, ..light(towards, [IRRADIANCE; 3]) }
}

/// What comes through a plate of light that falls on its back by an angle of that cosine, as display values. It is looked up at three
/// places across the slope, with binomial weights, 0.8 of the spread apart, where the light has as much farther to go as the plate leans.
fn through(profile: TwoGaussians, model: &KernelModel, cosine: f32, thickness: f32) -> [f32; 3] {
    let slope = (1.0 - cosine * cosine).sqrt() / cosine;
    let places = [(-1.0, 0.25), (0.0, 0.5), (1.0, 0.25)];
    let shares = places.map(|(step, weight)| {
        let d = (thickness / cosine + step * slope * 0.8 * model.depth_variance.sqrt()).abs();
        share_through(profile, model.radius, d).map(|share| weight * share)
    });
    [0, 1, 2].map(|c| {
        shares.iter().map(|share| share[c]).sum::<f32>() * model.reflectance[c] * value_of(model, cosine, NORMALS[0])
    })
}

/// Plates let through what the tail of their profile says, straight and aslant, and as much more as a light in front of them does.
#[test]
fn plates_let_light_through() {
    let mesh = PLATES.iter().map(|&(left, thick)| plate(left, left + 8.0, 0.0, thick));
    let mesh = mesh.reduce(|all, plate| joined(&all, &plate)).unwrap();
    let [straight, aslant, front] = [Vec3::NEG_Z, Vec3::new(0.0, 0.5, -1.0), Vec3::new(0.0, 1.0, 1.0)];
    for (backend, (profile, model)) in Backend::ALL
        .into_iter()
        .flat_map(|backend| [(SKIN, skin(17)), (WIDE, difference(11))].map(|model| (backend, model)))
    {
        let gpu = open(backend);
        let file = model.to_bytes().unwrap();
        for lights in [vec![straight], vec![aslant], vec![straight, front]] {
            let scene = Scene { lights: lights.iter().copied().map(with_shadow).collect(), ..planes(8.0) };
            let picture = drawn(&gpu, &[(&mesh, &file)], &scene, PLANES, linear());
            for (column, (_, thickness)) in COLUMNS.into_iter().zip(PLATES) {
                let found = picture[(PLANES[1] / 2 * PLANES[0] + column) as usize];
                let mut expected = [0.0; 3];
                for towards in &lights {
                    let cosine = towards.normalize().z;
                    let light = match cosine < 0.0 {
                        true => through(profile, &model, -cosine, thickness),
                        false => model.reflectance.map(|share| share * value_of(&model, cosine, NORMALS[0])),
                    };
                    (0..3).for_each(|c| expected[c] += light[c]);
                }
                println!("{backend}, lights from {lights:?}, {thickness} mm: {found:?}, expected {expected:.1?}");
                let is_close = |c: usize| (f32::from(found[c]) - expected[c].min(255.0)).abs() <= TOLERANCE;
                assert!((0..3).all(is_close), "{backend}, {lights:?}, {thickness} mm: {found:?}, {expected:?}");
            }
        }
    }
}

/// Light that enters one kernel does not come out of another, which lies in its shadow.
#[test]
fn plates_darken_what_is_behind_them() {
    let [near, far] = [plate(-12.0, 12.0, 0.0, 0.4), plate(0.0, 12.0, 3.0, 0.4)];
    let scene = Scene { lights: vec![with_shadow(Vec3::NEG_Z)], ..planes(8.0) };
    let [skin, other] = [skin(17), difference(11)];
    for backend in Backend::ALL {
        let [of_near, of_far] = [&skin, &other].map(|model| model.to_bytes().unwrap());
        let picture = drawn(&open(backend), &[(&near, &of_near), (&far, &of_far)], &scene, PLANES, linear());
        let at = |column: u32| picture[(PLANES[1] / 2 * PLANES[0] + column) as usize];
        let expected = through(SKIN, &skin, 1.0, 0.4);
        let is_close = |c: usize| (f32::from(at(20)[c]) - expected[c]).abs() <= TOLERANCE;
        assert!((0..3).all(is_close), "{backend}: {:?}, {expected:?}", at(20));
        assert_eq!(at(100), [0; 3], "{backend}: behind the other plate");
    }
}
