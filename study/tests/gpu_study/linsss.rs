//! LinSSS as it is drawn, beside the sums that it stands for and beside our own technique where both are the same.

use glam::{Vec2, Vec3};
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::baseline::linsss::LinSss;
use subsurf_encoder::metrics::psnr_db;
use subsurf_runtime::{Backend, Gpu, GpuMesh, LinsssMaterial, LinsssModel, Load, Material, RuntimeOptions, VertexData};
use subsurf_scene::{Camera, Environment, Light, LightShape, Mapping, Mesh, Scene, Shadow};
use subsurf_shaders::separable::{BasisNumbers, ProjectedBasis};
use subsurf_tests::frames::device;
use subsurf_tests::{drawable, shape};
use subsurf_viewer::{GpuAsset, RenderSession};

/// Pixels of the patch to a side.
const WIDTH: u32 = 32;
const SIDE: usize = WIDTH as usize;
/// Pixels of pictures to a pixel of the patch.
const SCALE: usize = 3;
const PITCH_MM: f32 = 0.5;

/// Square of the size of a patch, seen from above, and a light on it.
fn plate(shape: LightShape) -> (Mesh, Scene) {
    #[allow(clippy::cast_precision_loss, reason = "a few dozen pixels")]
    let half_mm = 0.5 * SIDE as f32 * PITCH_MM;
    let corners = [[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]];
    let positions = corners.map(|[x, z]| Vec3::new(half_mm * x, 0.0, half_mm * z)).to_vec();
    // Along y, z is up in the picture: x goes to the left.
    let uvs = corners.map(|[x, z]| Vec2::new(0.5 - 0.5 * x, 0.5 + 0.5 * z)).to_vec();
    let mesh = Mesh::new(positions, vec![Vec3::Y; 4], Some(uvs), vec![[0, 1, 2], [0, 2, 3]], 1.0).unwrap();
    let eye_mm = Vec3::new(0.0, 8.0 * half_mm, 0.0);
    let scene = Scene {
        lights: vec![Light { shape, irradiance: [1.5; 3], shadow: Shadow::None }],
        environment: Environment::uniform([0.0; 3]),
        roughness: 0.1,
        camera: Camera { eye_mm, target_mm: Vec3::ZERO, fov_y_rad: 2.0 * 0.125_f32.atan(), exposure: 3.0 },
    };
    (mesh, scene)
}

/// Linear light at the middles of the patch's pixels, row by row.
fn picture(gpu: &Gpu, material: Material, mesh: &Mesh, scene: &Scene) -> Vec<[f64; 3]> {
    let size = [WIDTH * u32::try_from(SCALE).unwrap(); 2];
    let mesh = GpuMesh::upload(gpu, mesh, VertexData::default()).unwrap();
    let asset = GpuAsset { mesh, material, mapping: Mapping::Uv([1.0; 2]) };
    let options = RuntimeOptions { map_bytes_per_pixel: 1e3, tone_mapping: false, ..RuntimeOptions::default() };
    let mut session = RenderSession::new(gpu, asset, scene, size, options).unwrap();
    let pixels = session.picture(gpu, scene).unwrap();
    let at = |[x, y]: [usize; 2]| pixels[(y * SCALE + SCALE / 2) * SIDE * SCALE + x * SCALE + SCALE / 2];
    let places = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| [x, y]));
    let found: Vec<[f64; 3]> = places.map(|place| at(place).map(|value| f64::from(value) / 255.0)).collect();
    let brightest = found.iter().flatten().copied().fold(0.0, f64::max);
    assert!((0.3..1.0).contains(&brightest), "exposed so that little is lost: {brightest}");
    found
}

/// PSNR in dB over what is further than so many pixels from the border, each scaled so that the largest value is 1 and `found` as
/// bright as `reference`.
fn psnr(reference: &[[f64; 3]], found: &[[f64; 3]], border: usize) -> f64 {
    let inside = |k: &usize| [k % SIDE, k / SIDE].iter().all(|at| (border..SIDE - border).contains(at));
    let of = |image: &[[f64; 3]]| (0..image.len()).filter(inside).map(|k| image[k]).collect::<Vec<_>>();
    let (reference, found) = (of(reference), of(found));
    let sum = |image: &[[f64; 3]]| image.iter().flatten().sum::<f64>();
    let (peak, gain) = (reference.iter().flatten().copied().fold(0.0, f64::max), sum(&reference) / sum(&found));
    let scaled =
        |image: &[[f64; 3]], by: f64| image.iter().map(|rgb| rgb.map(|value| by * value / peak)).collect::<Vec<_>>();
    psnr_db(&scaled(&reference, 1.0), &scaled(&found, gain))
}

fn model(sigmas_px: Vec<[f32; 3]>, weights: Vec<Vec<[f32; 3]>>, is_shortcut: bool) -> LinsssModel {
    let header = shape([WIDTH; 2], 6, Addressing::Clamp).header();
    LinsssModel { header, sigmas_px, weights, albedo: vec![[0.5; 3]; SIDE * SIDE], is_shortcut }
}

fn drawn(gpu: &Gpu, model: &LinsssModel, shape: LightShape) -> Vec<[f64; 3]> {
    let (mesh, scene) = plate(shape);
    picture(gpu, Material::Linsss(LinsssMaterial::upload(gpu, model).unwrap().into()), &mesh, &scene)
}

/// Aside, so that the eye sees no highlight.
const FROM_AFAR: LightShape = LightShape::Directional { towards: Vec3::new(1.0, 0.8, 0.3) };

/// Cone that lights a disc in the middle.
const CONE: LightShape =
    LightShape::Spot { position_mm: Vec3::new(24.0, 24.0, 0.0), target_mm: Vec3::ZERO, half_angle_rad: 0.1 };

#[test]
fn blurs_of_a_texture_are_its_sums_over_pairs() {
    #[allow(clippy::cast_precision_loss, reason = "a few dozen pixels")]
    let wave = |k: usize, phase: f32| 0.5 + 0.5 * (std::f32::consts::TAU * k as f32 / 8.0 + phase).cos();
    let plane = |h: usize, c: usize| -> Vec<f32> {
        let colour = [[0.8, 0.5, 0.2], [0.2, 0.5, 0.6]][h][c];
        (0..SIDE * SIDE).map(|k| colour * wave(k % SIDE, h as f32) * wave(k / SIDE, c as f32)).collect()
    };
    let fit = LinSss {
        size: [SIDE; 2],
        radius: 8,
        pitch_mm: PITCH_MM,
        sigmas: vec![[0.7, 0.8, 0.9], [1.8, 2.0, 2.2]],
        weights: (0..2).map(|h| [0, 1, 2].map(|c| plane(h, c))).collect(),
    };
    let expected = fit.exitance(&[1.0; SIDE * SIDE]);
    let (sigmas, weights) = fit.on_the_plane();
    for backend in [Backend::Vulkan, Backend::Gl] {
        let gpu = device(backend);
        let found = [false, true].map(|is_shortcut| {
            psnr(&expected, &drawn(&gpu, &model(sigmas.clone(), weights.clone(), is_shortcut), FROM_AFAR), 8)
        });
        println!("{backend}: {found:.1?} dB");
        assert!(found.iter().all(|db| *db > 38.0), "{backend}: {found:.1?} dB, by blurs and by the shortcut");
    }
}

/// Where the material is the same everywhere, the shortcut leaves out nothing but what the pyramid does.
#[test]
fn one_profile_everywhere_is_drawn_as_the_homogeneous_technique_draws_it() {
    let file = drawable([WIDTH; 2], 6, Addressing::Clamp);
    let material = Bssrdf::parse(&file).unwrap();
    let basis = ProjectedBasis::of(&material).unwrap().homogeneous();
    let numbers: &BasisNumbers = basis.numbers();
    let weights: Vec<[f32; 3]> = numbers.weights_of(0, 0).to_vec();
    let planes: Vec<Vec<[f32; 3]>> = weights.iter().map(|weight| vec![*weight; SIDE * SIDE]).collect();
    let sigmas: Vec<[f32; 3]> = numbers.sigmas().iter().map(|sigma| [*sigma; 3]).collect();
    let gpu = device(Backend::Vulkan);
    let (mesh, scene) = plate(CONE);
    let ours = Load::separable(&gpu, &material, numbers).unwrap().finish().unwrap();
    let ours = picture(&gpu, ours.into(), &mesh, &scene);
    let [exact, shortcut] =
        [false, true].map(|is_shortcut| drawn(&gpu, &model(sigmas.clone(), planes.clone(), is_shortcut), CONE));
    let found = [psnr(&ours, &exact, 2), psnr(&exact, &shortcut, 2)];
    println!("{found:.1?} dB, sigma {sigmas:?}");
    assert!(found[0] > 38.0, "{:.1} dB from the homogeneous technique", found[0]);
    assert!(found[1] > 35.0, "the pyramid is {:.1} dB from blurs", found[1]);
}
