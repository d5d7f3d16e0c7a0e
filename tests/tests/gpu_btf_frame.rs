//! Pictures of meshes of BTFs on Vulkan and on OpenGL ES 3.0 against their CPU twin, and against themselves.

use std::sync::Arc;

use glam::{Vec2, Vec3};
use subsurf_decoder::NestedBtf;
use subsurf_decoder::btf::{ColourEncoding, Grid};
use subsurf_encoder::synthetic::NestedShape;
use subsurf_runtime::{
    BACKGROUND, Backend, BtfFiltering, BtfLayout, BtfMaterial, BtfOptions, Error, Gpu, GpuMesh, Input, Material,
    Object, PictureTarget, Renderer, RuntimeOptions, Technique, VertexData,
};
use subsurf_scene::{
    Camera, Environment, Light, LightShape, MAX_LIGHTS, Mapping, Mesh, Placement, REFLECTION_SIZE, Scene, Shadow,
    sphere, torus,
};
use subsurf_shaders::{cpu, uniform};
use subsurf_tests::frames::device;

/// Display values: a step of 255 for rounding, and one for the half floats of the environment.
const DISPLAY_TOLERANCE: u8 = 2;
/// Share of a picture's pixels that may differ more: drivers snap vertices to a grid of subpixels, and a pixel on an edge
/// goes to one triangle or the other; levels of detail differ with them.
const EDGE_PIXELS: f64 = 0.01;
const SIZE: [u32; 2] = [160, 120];

/// A piece of a dome, 16 × 16 mm, that throws no shadow on itself.
fn dome() -> Mesh {
    const SIDE: u16 = 12;
    let place = |k: u16| f32::from(k) / f32::from(SIDE);
    let corners: Vec<Vec2> = (0..=SIDE).flat_map(|y| (0..=SIDE).map(move |x| Vec2::new(place(x), place(y)))).collect();
    let position = |uv: &Vec2| {
        let at = (*uv - 0.5) * 16.0;
        Vec3::new(at.x, -0.03 * at.length_squared(), -at.y)
    };
    let quads = (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| u32::from(y * (SIDE + 1) + x)));
    let row = u32::from(SIDE) + 1;
    let triangles = quads.flat_map(|k| [[k, k + 1, k + row], [k + 1, k + row + 1, k + row]]).collect();
    Mesh::new(corners.iter().map(position).collect(), Vec::new(), Some(corners), triangles, 1.0).unwrap()
}

/// A light from afar, one nearby, and a sky that is brighter above.
fn scene(lights: usize) -> Scene {
    let sky: Vec<[f32; 3]> = (0..16 * 8).map(|k| [0.9, 0.8, 0.6].map(|c| c * (2.0 - (k / 16) as f32 / 8.0))).collect();
    let mut all = vec![
        Light {
            shape: LightShape::Directional { towards: Vec3::new(0.5, 1.0, 0.4) },
            irradiance: [3.0, 2.8, 2.5],
            shadow: Shadow::Drawn,
        },
        Light {
            shape: LightShape::Point { position_mm: Vec3::new(-9.0, 14.0, 3.0) },
            irradiance: [0.8, 0.5, 0.2],
            shadow: Shadow::Drawn,
        },
    ];
    all.truncate(lights);
    Scene {
        lights: all,
        environment: Environment::equirectangular([16, 8], &sky).unwrap(),
        roughness: 0.3,
        camera: Camera { eye_mm: Vec3::new(6.0, 22.0, 28.0), target_mm: Vec3::ZERO, fov_y_rad: 0.5, exposure: 0.8 },
    }
}

fn picture(
    gpu: &Gpu,
    btf: &NestedBtf<'_>,
    mesh: &Mesh,
    copies: [f32; 2],
    scene: &Scene,
    options: BtfOptions,
) -> Vec<[u8; 3]> {
    let tangents = mesh.tangents().unwrap();
    let known = VertexData { tangents: Some(&tangents), ..Default::default() };
    let on_gpu = GpuMesh::upload(gpu, mesh, known).unwrap();
    let material = Material::Btf(BtfMaterial::upload(gpu, btf).unwrap().into(), 0);
    let objects = [Object::new(&on_gpu, &material, Mapping::Uv(copies), scene.roughness)];
    let input = Input::new(scene, &objects, SIZE);
    let options = RuntimeOptions { btf: options, ..RuntimeOptions::default() };
    let renderer = Renderer::for_technique(gpu, material.technique(), options).unwrap();
    let mut frame = renderer.prepare(gpu, &input, SIZE).unwrap();
    renderer.picture(gpu, &mut frame, &input, &PictureTarget::new(gpu, SIZE, &options).unwrap()).unwrap()
}

fn twin(btf: &NestedBtf<'_>, mesh: &Mesh, copies: [f32; 2], scene: &Scene, options: BtfOptions) -> Vec<[u8; 3]> {
    let block = uniform::Blocks::new(scene, &Placement::of_btf(mesh, copies), SIZE, 512);
    let uvs = mesh.uvs.as_ref().unwrap().iter().map(|uv| *uv * Vec2::from(copies));
    let uvs: Vec<Vec2> = uvs.map(|uv| Vec2::new(uv.x, 1.0 - uv.y)).collect();
    let triangles = cpu::BtfTriangles {
        positions: &mesh.positions,
        normals: &mesh.normals,
        uvs: &uvs,
        tangents: &mesh.tangents().unwrap(),
        visibilities: &vec![[1.0; MAX_LIGHTS]; mesh.positions.len()],
        triangles: &mesh.triangles,
    };
    let BtfOptions { filtering, samples } = options;
    let surface = cpu::BtfSurface { btf, material: 0, filtering, samples };
    let reflections = cpu::Reflections { size: REFLECTION_SIZE, levels: scene.environment.reflections() };
    cpu::shade_btf(&triangles, &surface, &block.scene, &reflections, SIZE, [BACKGROUND; 3])
}

fn share_that_differs(a: &[[u8; 3]], b: &[[u8; 3]]) -> f64 {
    let differs = |(a, b): &(&[u8; 3], &[u8; 3])| (0..3).any(|c| a[c].abs_diff(b[c]) > DISPLAY_TOLERANCE);
    a.iter().zip(b).filter(differs).count() as f64 / a.len() as f64
}

fn pixels(backend: Backend) {
    let gpu = device(backend);
    let mesh = dome();
    let small = NestedShape { materials: vec![(12, 8, 3), (4, 4, 1)], ..NestedShape::typical() };
    let bright = ColourEncoding::LogLuv { toe: 0.01, peak: 9.0 };
    let grid = Grid { cos_light_min: 0.2, theta_max: 1.3, ..Grid::PAPER };
    let files = [
        ("display", small.database(2).to_bytes()),
        (
            "LogLuv",
            NestedShape { tone: bright, grid, is_relative: true, stages: 2, tints: 9, ..small }.database(3).to_bytes(),
        ),
    ];
    for (name, file) in &files {
        let btf = NestedBtf::parse(file).unwrap();
        // Copies so large that texels are seen, and so small that coarser levels are.
        for (copies, filtering, lights, samples) in [
            ([2.0, 3.0], BtfFiltering::Bilinear, 2, 0),
            ([2.0, 3.0], BtfFiltering::Trilinear, 0, 8),
            ([20.0, 30.0], BtfFiltering::Trilinear, 2, 0),
            ([9.0, 16.0], BtfFiltering::Trilinear, 2, 3),
        ] {
            let (scene, options) = (scene(lights), BtfOptions { filtering, samples });
            let found = picture(&gpu, &btf, &mesh, copies, &scene, options);
            let expected = twin(&btf, &mesh, copies, &scene, options);
            let share = share_that_differs(&found, &expected);
            let covered = expected.iter().filter(|pixel| **pixel != [BACKGROUND; 3]).count();
            println!("{backend}, {name}, {copies:?}, {filtering:?}, {samples} samples: {share:.5} of pixels differ");
            assert!(covered * 4 > expected.len(), "the mesh is in the picture");
            let mean = expected.iter().flatten().map(|c| f64::from(*c)).sum::<f64>() / (3 * expected.len()) as f64;
            assert!((20.0..200.0).contains(&mean), "{name}: neither black nor white: {mean}");
            assert!(share <= EDGE_PIXELS, "{backend}, {name}, {filtering:?}, {samples} samples: {share}");
        }
    }
}

#[test]
fn pixels_are_those_of_the_twin_on_vulkan() {
    pixels(Backend::Vulkan);
}

#[test]
fn pixels_are_those_of_the_twin_on_gles_3_0() {
    pixels(Backend::Gl);
}

/// Light from all around, by samples, comes to what the decoder's albedo says: under white light from all sides, a texel has
/// the radiance of its albedo.
#[test]
fn white_surroundings_show_the_albedo() {
    let shape = NestedShape { materials: vec![(1, 1, 1)], ..NestedShape::typical() };
    let file = shape.database(11).to_bytes();
    let btf = NestedBtf::parse(&file).unwrap();
    let mesh = dome();
    let scene = Scene { environment: Environment::uniform([2.0 * std::f32::consts::PI; 3]), ..scene(0) };
    let options = BtfOptions { filtering: BtfFiltering::Nearest, samples: 256 };
    let texel = btf.texel(0, 0, [0, 0]).unwrap();
    for gpu in Backend::ALL.map(device) {
        let found = picture(&gpu, &btf, &mesh, [1.0; 2], &scene, options);
        // The middle of the dome, seen from where the eye is: x along x, y down the picture, which is towards z.
        let towards = scene.camera.eye_mm.normalize();
        let albedo = btf.albedo(texel, [towards.x, towards.z, towards.y]);
        let light = albedo.map(|value| 2.0 * value * scene.camera.exposure);
        let expected = cpu::display(cpu::srgb(cpu::neutral(light)));
        let middle = found[(SIZE[1] / 2 * SIZE[0] + SIZE[0] / 2) as usize];
        println!("{:?}: {middle:?}, by the albedo {expected:?}", gpu.info().backend);
        assert!((0..3).all(|c| middle[c].abs_diff(expected[c]) <= 3), "{middle:?} {expected:?}");
        assert!(middle[1] > BACKGROUND, "not the background");
    }
}

/// Materials that are not there, meshes without tangents, too little memory.
#[test]
fn what_cannot_be_drawn_is_said() {
    let file = NestedShape::small().database(1).to_bytes();
    let btf = NestedBtf::parse(&file).unwrap();
    let gpu = device(Backend::Gl);
    let mesh = torus(6.0, 2.0, 12);
    let tangents = mesh.tangents().unwrap();
    let material: Arc<BtfMaterial> = BtfMaterial::upload(&gpu, &btf).unwrap().into();
    let known = VertexData { tangents: Some(&tangents), ..Default::default() };
    let on_gpu = GpuMesh::upload(&gpu, &mesh, known).unwrap();
    let bare = GpuMesh::upload(&gpu, &mesh, VertexData::default()).unwrap();
    let scene = scene(1);
    let draw = |mesh, number, mapping, options| {
        let material = Material::Btf(material.clone(), number);
        let objects = [Object::new(mesh, &material, mapping, 0.3)];
        let input = Input::new(&scene, &objects, SIZE);
        let renderer = Renderer::for_technique(&gpu, Technique::Btf(BtfLayout::Nested), options).unwrap();
        let mut frame = renderer.prepare(&gpu, &input, SIZE)?;
        let target = PictureTarget::new(&gpu, SIZE, &options).unwrap();
        renderer.picture(&gpu, &mut frame, &input, &target)
    };
    let (copies, plain) = (Mapping::Uv([4.0, 2.0]), RuntimeOptions::default());
    let refusal = |mesh, number, mapping| draw(mesh, number, mapping, plain).unwrap_err().to_string();
    assert!(refusal(&on_gpu, 1, copies).contains("material 1 of a BTF of 1"), "no such material");
    assert!(refusal(&bare, 0, copies).contains("tangents"), "no tangents");
    assert!(refusal(&on_gpu, 0, Mapping::Box).contains("texture coordinates"), "no box mapping");
    let budget = RuntimeOptions { budget_bytes: Some(100_000), ..plain };
    match draw(&on_gpu, 0, copies, budget) {
        Err(Error::OverBudget { .. }) => {}
        other => panic!("{:?}", other.map(|_| ())),
    }
    assert!(Mesh { uvs: None, ..sphere(1.0, 4) }.tangents().is_err(), "no texture coordinates");
}
