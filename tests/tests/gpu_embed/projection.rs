//! Projections that are far from those of a camera which looks at its object through square pixels.

use glam::{Mat4, Vec3, Vec4};
use subsurf_runtime::{BACKGROUND, Backend, Gpu, Input, PictureTarget, RuntimeOptions};
use subsurf_scene::{Mesh, View, torus};
use subsurf_tests::frames::{Loaded, RenderMode, device, material_of, psnr, scene};

/// Picture of `size` pixels of a mesh under a view, with maps as fine as the material asks for.
fn picture(gpu: &Gpu, mode: RenderMode, file: &[u8], mesh: &Mesh, view: View, size: [u32; 2]) -> Vec<[u8; 3]> {
    let loaded = Loaded::new(gpu, mode, file, mesh);
    let scene = scene(mesh);
    let objects = [loaded.object(&scene)];
    let input = Input { view, ..Input::new(&scene, &objects, size) };
    let options = RuntimeOptions { map_bytes_per_pixel: 64.0, ..RuntimeOptions::default() };
    let renderer = loaded.renderer(gpu, options).unwrap();
    let mut frame = renderer.prepare(gpu, &input, size).unwrap();
    let target = PictureTarget::new(gpu, size, renderer.options()).unwrap();
    renderer.picture(gpu, &mut frame, &input, &target).unwrap()
}

/// Projection of what lies between tangents of the angles from the axis: left, right, bottom, top.
fn off_centre([left, right, bottom, top]: [f32; 4], near: f32, far: f32) -> Mat4 {
    Mat4::from_cols(
        Vec4::new(2.0 / (right - left), 0.0, 0.0, 0.0),
        Vec4::new(0.0, 2.0 / (top - bottom), 0.0, 0.0),
        Vec4::new((right + left) / (right - left), (top + bottom) / (top - bottom), far / (near - far), -1.0),
        Vec4::new(0.0, 0.0, near * far / (near - far), 0.0),
    )
}

/// In the corner of a wide picture, spheres look like long ellipses, and splats cover them.
#[test]
fn splats_cover_what_they_light_in_the_corner_of_a_wide_picture() {
    let file = material_of("jade");
    let mesh = torus(9.0, 4.0, 24);
    // 76 degrees from the axis, 25 mm in front of the eye.
    let along = Vec3::new(3.0, 2.6, -1.0);
    let view_from_world = Mat4::from_translation(25.0 * along);
    let window = [along.x - 1.75, along.x + 1.75, along.y - 1.55, along.y + 1.55];
    let view = View { view_from_world, clip_from_view: off_centre(window, 5.0, 60.0) };
    let gpus = Backend::ALL.map(device);
    let draw = |gpu, mode| picture(gpu, mode, &file, &mesh, view, [160, 120]);
    let gather = draw(&gpus[0], RenderMode::Gather);
    for gpu in &gpus {
        let db = psnr(&gather, &draw(gpu, RenderMode::Splat));
        println!("{:?}: {db:.1} dB between splats and the gather", gpu.info().backend);
        assert!(db >= 37.0, "{db} dB");
    }
}

/// Pixels a quarter as wide show the same picture in four times as many columns.
#[test]
fn pixels_need_not_be_square() {
    let file = material_of("chessboard");
    let mesh = torus(9.0, 4.0, 32);
    let size = [120, 90];
    let usual = Input::new(&scene(&mesh), &[], size).view;
    let view = View { clip_from_view: off_centre([-0.4, 0.4, -0.3, 0.3], 10.0, 100.0), ..usual };
    for gpu in Backend::ALL.map(device) {
        for (mode, least_db) in [(RenderMode::Splat, 46.0), (RenderMode::Separable, 47.0)] {
            let [square, narrow] =
                [size, [4 * size[0], size[1]]].map(|size| picture(&gpu, mode, &file, &mesh, view, size));
            let mean = |pixels: &[[u8; 3]; 4]| {
                [0, 1, 2].map(|c| {
                    let sum: u16 = pixels.iter().map(|pixel| u16::from(pixel[c])).sum();
                    u8::try_from((sum + 2) / 4).unwrap()
                })
            };
            // Where the mesh covers some of the five only, the place of its edge within a pixel would be judged.
            let is_covered = |pixel: &[u8; 3]| *pixel != [BACKGROUND; 3];
            let alike = std::iter::zip(&square, narrow.as_chunks::<4>().0)
                .filter(|(one, four)| four.iter().all(|pixel| is_covered(pixel) == is_covered(one)));
            let (one, four): (Vec<_>, Vec<_>) = alike.map(|(one, four)| (*one, mean(four))).unzip();
            let at_edges = square.len() - one.len();
            assert!(4 * at_edges < square.iter().filter(|pixel| is_covered(pixel)).count(), "{at_edges} at edges");
            let db = psnr(&one, &four);
            println!("{:?}, {mode:?}: {db:.1} dB between square pixels and narrow ones", gpu.info().backend);
            assert!(db >= least_db, "{mode:?}: {db} dB");
        }
    }
}
