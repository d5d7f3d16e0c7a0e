//! Projections that are far from those of a camera which looks at its object through square pixels.

use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3, Vec4};
use subsurf_runtime::{Backend, Gpu, Input, PictureTarget, RuntimeOptions};
use subsurf_scene::{Mesh, View, torus};
use subsurf_tests::frames::{Loaded, RenderMode, device, material_of, psnr, scene};

/// Picture of `size` pixels of a mesh under a view.
fn picture(gpu: &Gpu, mode: RenderMode, file: &[u8], mesh: &Mesh, view: View, size: [u32; 2]) -> Vec<[u8; 3]> {
    let loaded = Loaded::new(gpu, mode, file, mesh);
    let scene = scene(mesh);
    let objects = [loaded.object(&scene)];
    let input = Input { view, ..Input::new(&scene, &objects, size) };
    let renderer = loaded.renderer(gpu, RuntimeOptions::default()).unwrap();
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
    // 60 degrees from the axis.
    let along = Vec3::new(1.3, 1.1, -1.0);
    let eye_mm = Vec3::new(-24.0, -2.0, 40.0);
    let forward = -Vec3::Z;
    let view_from_world = look_at_mat4(eye_mm, eye_mm + forward, Vec3::Y);
    let shift = eye_mm + 25.0 * along;
    let view_from_world = view_from_world * Mat4::from_translation(shift);
    let window = [along.x - 0.9, along.x + 0.9, along.y - 0.7, along.y + 0.7];
    let view = View { view_from_world, clip_from_view: off_centre(window, 5.0, 60.0) };
    let gpus = Backend::ALL.map(device);
    let draw = |gpu, mode| picture(gpu, mode, &file, &mesh, view, [160, 120]);
    let gather = draw(&gpus[0], RenderMode::Gather);
    for gpu in &gpus {
        let db = psnr(&gather, &draw(gpu, RenderMode::Splat));
        println!("{:?}: {db:.1} dB between splats and the gather", gpu.info().backend);
        assert!(db >= 33.0, "{db} dB");
    }
}

/// Pixels half as wide show the same picture in twice as many columns.
#[test]
fn pixels_need_not_be_square() {
    let file = material_of("chessboard");
    let mesh = torus(9.0, 4.0, 32);
    let size = [160, 120];
    let usual = Input::new(&scene(&mesh), &[], size).view;
    let view = View { clip_from_view: off_centre([-0.4, 0.4, -0.3, 0.3], 10.0, 100.0), ..usual };
    for gpu in Backend::ALL.map(device) {
        for mode in [RenderMode::Splat, RenderMode::Separable] {
            let [square, narrow] =
                [size, [2 * size[0], size[1]]].map(|size| picture(&gpu, mode, &file, &mesh, view, size));
            let pairs = narrow.as_chunks::<2>().0.iter();
            let mean = pairs.map(|[a, b]| [0, 1, 2].map(|c| u8::midpoint(a[c], b[c]))).collect::<Vec<_>>();
            let db = psnr(&square, &mean);
            println!("{:?}, {mode:?}: {db:.1} dB between square pixels and narrow ones", gpu.info().backend);
            assert!(db >= 36.0, "{db} dB");
        }
    }
}
