//! Frames of meshes: every path on both APIs, against the reference gather, within budgets, and without leaks.

use glam::Vec3;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::bssrdf::{Options, encode};
use subsurf_encoder::metrics::psnr_db;
use subsurf_encoder::simulate::{Finish, Scene as Recipe};
use subsurf_encoder::synthetic::per_pixel_of;
use subsurf_runtime::scene::{
    Environment, Light, LightShape, Mapping, Mesh, Outline, Scene, SkyShare, Surface, View, bowl, drapery, knot, torus,
};
use subsurf_runtime::{
    BACKGROUND, Backend, Error, Frame, Gpu, GpuMesh, GpuPoints, Known, Material, Model, Path, Renderer, RuntimeOptions,
    SeparableMaterial, SplatMaterial,
};
use subsurf_shaders::separable::{Detail, Factors};
use subsurf_tests::{shape, simulated};

/// Display values: steps of 255 between the two APIs. Their arithmetic is the same but for rounding; sums of splats are
/// half floats that lose up to 2⁻¹¹ with each addition.
const API_TOLERANCE: u8 = 2;
/// Share of pixels that may differ more: edges of triangles and of shadows, where a sample goes to one side or the other.
const EDGE_PIXELS: f64 = 0.01;
const SIZE: [u32; 2] = [320, 240];

fn device(backend: Backend) -> Gpu {
    Gpu::open(backend).unwrap_or_else(|error| panic!("{error}: run `make test`, which installs one"))
}

/// One light from the side, with shadow, and a sky, seen from where a mesh fills the picture.
fn scene(mesh: &Mesh) -> Scene {
    let radius = mesh.positions.iter().map(|position| position.length()).fold(0.0, f32::max);
    let towards = Vec3::new(0.5, 0.3, 0.8).normalize();
    Scene {
        lights: vec![Light {
            shape: LightShape::Directional { towards: Vec3::new(0.9, 1.1, 0.35) },
            irradiance: [3.0, 2.9, 2.7],
        }],
        environment: Environment::uniform([0.35, 0.4, 0.5]),
        roughness: 0.25,
        view: View { eye_mm: 4.2 * radius * towards, target_mm: Vec3::ZERO, angle: 0.5, exposure: 0.9 },
    }
}

/// What paths draw.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Way {
    Gather,
    Splat,
    Separable,
}

/// A mesh and a material on a device, for one path.
#[allow(clippy::large_enum_variant, reason = "one or two at a time, and they stay where they are")]
enum Loaded {
    Gather(GpuMesh, GpuPoints, Material),
    Splat(GpuMesh, SplatMaterial),
    Separable(GpuMesh, SeparableMaterial),
}

impl Loaded {
    fn new(gpu: &Gpu, way: Way, file: &[u8], mesh: &Mesh) -> Self {
        let material = Bssrdf::parse(file).unwrap();
        let mapping = Mapping::Uv([2.0, 1.0]);
        let outline = Outline::new(mesh, mapping, material.header());
        let factors = || Factors::of(&material, Detail::default());
        let lit = || {
            let shares = SkyShare::of(mesh, &material).unwrap();
            GpuMesh::upload(gpu, mesh, &outline, Known::Sky(&shares)).unwrap()
        };
        match way {
            Way::Gather => {
                // Fine enough that the sum is close to its integral.
                let fine = mesh.clone().subdivided(0.8 * material.header().pitch_mm).unwrap();
                let visibilities = shadows(&fine, mesh, &scene(mesh));
                let surface = Surface::new(&fine, mapping, material.header(), &visibilities);
                let on_gpu = GpuMesh::upload(gpu, &fine, &outline, Known::Points(surface.point_of())).unwrap();
                let points = GpuPoints::upload(gpu, &surface).unwrap();
                Self::Gather(on_gpu, points, Material::upload(gpu, &material).unwrap())
            }
            Way::Splat => Self::Splat(lit(), SplatMaterial::upload(gpu, &material, &factors()).unwrap()),
            Way::Separable => Self::Separable(lit(), SeparableMaterial::upload(gpu, &factors()).unwrap()),
        }
    }

    fn model(&self) -> Model<'_> {
        match self {
            Self::Gather(mesh, points, material) => Model::Gather { mesh, points, material },
            Self::Splat(mesh, material) => Model::Splat { mesh, material },
            Self::Separable(mesh, material) => Model::Separable { mesh, material },
        }
    }

    fn path(&self) -> Path {
        match self {
            Self::Gather(_, _, material) => Path::Gather(material.storage()),
            Self::Splat(_, material) => Path::Splat(material.planes().storage()),
            Self::Separable(_, material) => Path::Separable(material.terms()),
        }
    }

    fn picture(&self, gpu: &Gpu, scene: &Scene, size: [u32; 2]) -> Vec<[u8; 3]> {
        let renderer = Renderer::new(gpu, self.path(), RuntimeOptions::default()).unwrap();
        let mut frame = renderer.prepare(gpu, &self.model(), scene, size).unwrap();
        renderer.picture(gpu, &mut frame, &self.model(), scene).unwrap()
    }
}

/// Which vertices of a mesh the first light reaches, by trying all triangles of what is in its way.
fn shadows(mesh: &Mesh, opaque: &Mesh, scene: &Scene) -> Vec<[f32; 4]> {
    use rayon::prelude::*;
    let light = scene.lights[0];
    let triangles: Vec<[Vec3; 3]> =
        opaque.triangles.iter().map(|triangle| triangle.map(|k| opaque.positions[k as usize])).collect();
    let [low, high] = mesh.bounds();
    let offset = 2e-3 * (high - low).max_element();
    let vertices = mesh.positions.par_iter().zip(&mesh.normals);
    let seen = vertices.map(|(position, normal)| {
        let (towards, _) = light.direction_from(*position);
        let from = position + offset * normal;
        let hidden = normal.dot(towards) > 0.0 && triangles.iter().any(|triangle| is_hit(triangle, from, towards));
        [f32::from(u8::from(!hidden)); 4]
    });
    seen.collect()
}

/// Möller and Trumbore 1997.
fn is_hit([a, b, c]: &[Vec3; 3], from: Vec3, towards: Vec3) -> bool {
    let (ab, ac) = (b - a, c - a);
    let p = towards.cross(ac);
    let determinant = ab.dot(p);
    if determinant.abs() < 1e-12 {
        return false;
    }
    let t = from - a;
    let u = t.dot(p) / determinant;
    let q = t.cross(ab);
    let v = towards.dot(q) / determinant;
    u >= 0.0 && v >= 0.0 && u + v <= 1.0 && ac.dot(q) / determinant > 0.0
}

/// A small simulated material, encoded.
fn material_of(recipe: Recipe) -> Vec<u8> {
    let folder = tempfile::tempdir().unwrap();
    let capture = simulated(folder.path(), recipe, 32, 8, 0.8, Addressing::Repeat, &Finish::default());
    encode(&capture, None, &Options { base_materials: 32, ..Options::default() }, &()).unwrap().bytes
}

/// PSNR of display values over the pixels that the mesh covers in either picture.
fn psnr(reference: &[[u8; 3]], found: &[[u8; 3]]) -> f64 {
    let covered = reference.iter().zip(found).filter(|(a, b)| **a != [BACKGROUND; 3] || **b != [BACKGROUND; 3]);
    let value = |pixel: &[u8; 3]| pixel.map(|value| f64::from(value) / 255.0);
    let (a, b): (Vec<_>, Vec<_>) = covered.map(|(a, b)| (value(a), value(b))).unzip();
    assert!(10 * a.len() > reference.len(), "the mesh is in the picture");
    psnr_db(&a, &b)
}

/// Every path against the gather, on meshes thick and thin; and both APIs against each other.
#[test]
fn paths_come_close_to_the_gather_and_apis_to_each_other() {
    let file = material_of(Recipe::Jade);
    let gpus = Backend::ALL.map(device);
    let meshes = [("knot", knot(14.0, 4.5, 32)), ("bowl", bowl(12.0, 2.0, 32)), ("drapery", drapery(14.0, 1.0, 5, 40))];
    for (name, mesh) in &meshes {
        let scene = scene(mesh);
        let draw = |gpu: &Gpu, way| Loaded::new(gpu, way, &file, mesh).picture(gpu, &scene, SIZE);
        let reference = draw(&gpus[0], Way::Gather);
        for (way, least_db) in [(Way::Splat, 36.0), (Way::Separable, 28.0)] {
            let pictures = gpus.each_ref().map(|gpu| draw(gpu, way));
            let db = pictures.each_ref().map(|picture| psnr(&reference, picture));
            let [a, b] = &pictures;
            let far = |(a, b): (&[u8; 3], &[u8; 3])| (0..3).any(|c| a[c].abs_diff(b[c]) > API_TOLERANCE);
            let different = a.iter().zip(b).filter(|pair| far(*pair)).count();
            println!("{name}, {way:?}: {db:.1?} dB from the gather; {different} pixels differ between the APIs");
            assert!(db.iter().all(|db| *db >= least_db), "{name}, {way:?}: {db:?} dB");
            assert!(different as f64 <= EDGE_PIXELS * a.len() as f64, "{name}, {way:?}: {different} pixels");
        }
    }
}

/// 2-BMPP and per-pixel profiles of the same numbers give the same splats.
#[test]
fn splats_are_the_same_from_profiles_of_every_pixel() {
    let file = shape([31, 31], 6, Addressing::Mirror).bmpp();
    let profiles = per_pixel_of(&Bssrdf::parse(&file).unwrap());
    let mesh = torus(9.0, 4.0, 32);
    let gpu = device(Backend::Vulkan);
    let draw = |file: &[u8]| Loaded::new(&gpu, Way::Splat, file, &mesh).picture(&gpu, &scene(&mesh), SIZE);
    let (a, b) = (draw(&file), draw(&profiles));
    let worst = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(worst <= Some(API_TOLERANCE), "{worst:?}");
}

/// From so far away that a pixel holds many of the material's: as bright as the mean of a large picture, wherever exactly
/// pixels fall.
#[test]
fn far_meshes_do_not_shimmer() {
    const LARGER: u32 = 8;
    let file = material_of(Recipe::Chessboard);
    let mesh = torus(9.0, 4.0, 48);
    let gpu = device(Backend::Vulkan);
    let loaded = Loaded::new(&gpu, Way::Separable, &file, &mesh);
    let mut worst = f64::INFINITY;
    for step in 0..4_u8 {
        let mut far = scene(&mesh);
        far.view.eye_mm *= 6.0;
        far.view.target_mm = Vec3::new(0.0, 0.06 * f32::from(step), 0.0);
        let size = [160, 120];
        let small = loaded.picture(&gpu, &far, size);
        let large = loaded.picture(&gpu, &far, size.map(|side| LARGER * side));
        let mean = |x: u32, y: u32| {
            let block = (0..LARGER * LARGER).map(|k| [LARGER * x + k % LARGER, LARGER * y + k / LARGER]);
            let values = block.map(|[x, y]| large[(y * size[0] * LARGER + x) as usize].map(f64::from));
            let sum = values.fold([0.0; 3], |sum, pixel| [0, 1, 2].map(|c| sum[c] + pixel[c]));
            sum.map(|sum| sum / f64::from(255 * LARGER * LARGER))
        };
        // Where blocks are covered whole: edges are a matter of samples.
        let is_inside = |x: u32, y: u32| {
            (0..LARGER * LARGER).all(|k| {
                let at = (LARGER * y + k / LARGER) * size[0] * LARGER + LARGER * x + k % LARGER;
                large[at as usize] != [BACKGROUND; 3]
            })
        };
        let places = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
        let inside: Vec<(u32, u32)> = places.filter(|(x, y)| is_inside(*x, *y)).collect();
        let reference: Vec<[f64; 3]> = inside.iter().map(|(x, y)| mean(*x, *y)).collect();
        let found: Vec<[f64; 3]> = inside
            .iter()
            .map(|(x, y)| small[(y * size[0] + x) as usize].map(|value| f64::from(value) / 255.0))
            .collect();
        assert!(inside.len() > 50, "{} pixels", inside.len());
        worst = worst.min(psnr_db(&reference, &found));
    }
    println!("far away: at least {worst:.1} dB from {LARGER} × {LARGER} samples to a pixel");
    assert!(worst >= 32.0, "{worst} dB");
}

fn prepared(gpu: &Gpu, loaded: &Loaded, scene: &Scene, budget_bytes: Option<u64>) -> Result<Frame, Error> {
    let options = RuntimeOptions { budget_bytes, ..RuntimeOptions::default() };
    Renderer::new(gpu, loaded.path(), options)?.prepare(gpu, &loaded.model(), scene, SIZE)
}

#[test]
fn budgets_are_kept_or_refused() {
    let file = shape([31, 31], 6, Addressing::Mirror).bmpp();
    let mesh = torus(9.0, 4.0, 24);
    let scene = scene(&mesh);
    for gpu in Backend::ALL.map(device) {
        for way in [Way::Splat, Way::Separable, Way::Gather] {
            let loaded = Loaded::new(&gpu, way, &file, &mesh);
            let before = gpu.ledger().bytes();
            let frame = prepared(&gpu, &loaded, &scene, None).unwrap();
            let whole = gpu.ledger().bytes();
            let best = *frame.plan();
            drop(frame);
            assert_eq!(gpu.ledger().bytes(), before, "{way:?}: all of a frame is gone");

            let frame = prepared(&gpu, &loaded, &scene, Some(whole - 1)).unwrap();
            assert!(gpu.ledger().bytes() < whole, "{way:?}: {} bytes of {whole}", gpu.ledger().bytes());
            assert_ne!(*frame.plan(), best, "{way:?}: something had to become coarser");
            drop(frame);

            match prepared(&gpu, &loaded, &scene, Some(before + 1_000)) {
                Err(Error::OverBudget { need_bytes, budget_bytes }) => {
                    assert!(need_bytes > budget_bytes, "{need_bytes} {budget_bytes}");
                }
                other => panic!("{way:?}: {other:?}"),
            }
            assert_eq!(gpu.ledger().bytes(), before, "{way:?}: nothing was allocated");
        }
    }
}

/// Loading, resizing and dropping leaves nothing behind, by the ledger and by wgpu's allocator.
#[test]
fn a_thousand_loads_and_resizes_leave_nothing() {
    let gpu = device(Backend::Vulkan);
    let file = shape([16, 16], 3, Addressing::Mirror).bmpp();
    let mesh = torus(9.0, 4.0, 8);
    let scene = scene(&mesh);
    let options = RuntimeOptions { light_texels: 128, ..RuntimeOptions::default() };
    let allocated = || gpu.device().generate_allocator_report().map_or(0, |report| report.total_allocated_bytes);
    for way in [Way::Splat, Way::Separable] {
        let first = Loaded::new(&gpu, way, &file, &mesh);
        let renderer = Renderer::new(&gpu, first.path(), options).unwrap();
        drop(first);
        let mut after_some = (0, 0);
        for cycle in 0..1_000_u32 {
            let loaded = Loaded::new(&gpu, way, &file, &mesh);
            let size = [16 + cycle % 29, 16 + cycle % 31];
            let mut frame = renderer.prepare(&gpu, &loaded.model(), &scene, size).unwrap();
            if cycle % 50 == 0 {
                renderer.picture(&gpu, &mut frame, &loaded.model(), &scene).unwrap();
            }
            drop((loaded, frame));
            gpu.finish().unwrap();
            if cycle == 100 {
                after_some = (gpu.ledger().bytes(), allocated());
            }
        }
        println!("{way:?}: {after_some:?} bytes after 100 cycles, {} after 1000", allocated());
        assert_eq!(gpu.ledger().bytes(), after_some.0, "{way:?}: by the ledger");
        assert_eq!(gpu.ledger().bytes(), 0, "{way:?}: by the ledger");
        // The allocator keeps pages; it must not need more and more of them.
        assert!(allocated() <= after_some.1 + (1 << 20), "{way:?}: {} after {after_some:?}", allocated());
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
    let file = shape([128, 128], 6, Addressing::Mirror).bmpp();
    for way in [Way::Splat, Way::Separable] {
        let loaded = Loaded::new(&gpu, way, &file, &mesh);
        let options = RuntimeOptions::default();
        let renderer = Renderer::new(&gpu, loaded.path(), options).unwrap();
        let frame = renderer.prepare(&gpu, &loaded.model(), &scene, [640, 480]).unwrap();
        gpu.finish().unwrap();
        let (ours, theirs) = (gpu.ledger().bytes(), allocated() - before);
        println!("{way:?}: {ours} bytes by the ledger, {theirs} by the allocator");
        assert!(ours <= theirs && theirs <= ours + ours / 8 + (2 << 20), "{way:?}: {ours} {theirs}");
        drop((frame, renderer, loaded));
        gpu.finish().unwrap();
    }
}

/// An application's own device draws what ours draws.
#[test]
fn a_device_of_the_callers_own_draws_the_same() {
    let file = shape([31, 31], 6, Addressing::Mirror).bmpp();
    let mesh = torus(9.0, 4.0, 24);
    let scene = scene(&mesh);
    let ours = device(Backend::Vulkan);
    let theirs = Gpu::from_device(ours.device().clone(), ours.queue().clone(), ours.info().clone());
    let draw = |gpu: &Gpu| Loaded::new(gpu, Way::Separable, &file, &mesh).picture(gpu, &scene, SIZE);
    assert!(draw(&ours) == draw(&theirs), "the same picture");
    let kept = Loaded::new(&ours, Way::Separable, &file, &mesh);
    assert!(ours.ledger().bytes() > 0, "{:?} is there", kept.path());
    assert_eq!(theirs.ledger().bytes(), 0, "each has a ledger of its own");
}
