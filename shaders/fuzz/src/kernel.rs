//! Kernels: terms on the screen, and pictures of the ball.

use glam::Vec4;
use subsurf_decoder::Kernel;
use subsurf_scene::{Placement, View};
use subsurf_shaders::cpu::{blur_kernel, kernel_gbuffer, shade_kernel, sum_kernel};
use subsurf_shaders::uniform::{KernelProfile, KernelTerm, ScreenDomain};

use crate::stage::{BACKGROUND, SIZE, stage};

/// All that is made of a kernel.
///
/// # Panics
/// If something is no number.
pub fn kernel(kernel: &Kernel<'_>) {
    let stage = stage();
    let profile = KernelProfile::new(kernel);
    assert!(profile.reflectance.iter().all(|share| (0.0..=1.0).contains(share)), "{profile:?}");
    assert!(profile.radius_mm.is_finite() && profile.spread_mm.is_finite(), "{profile:?}");

    let bounds = stage.mesh.bounding_sphere();
    let blocks = stage.blocks(&Placement::of_homogeneous_within(bounds, kernel.header().eta));
    let [width, height] = SIZE.map(|side| side as f32);
    let view = View::new(&stage.scene.camera, &bounds, width / height);
    let focal = view.focal();
    let gbuffer = kernel_gbuffer(&stage.triangles(), &blocks, SIZE);
    let mut sums = vec![Vec4::ZERO; gbuffer.entered.len()];
    for (number, [rows, columns]) in KernelTerm::of(kernel).into_iter().enumerate() {
        let domain = ScreenDomain {
            size: SIZE,
            focal_texels: [0.5 * width * focal.x, 0.5 * height * focal.y],
            middle_mm: (bounds.centre_mm - view.eye_mm()).dot(view.forward()),
            pitch_mm: 1.0,
            perspective: 1.0,
            is_jittered: u32::from(number % 2 == 0),
        };
        let between = blur_kernel(&rows, &domain, &gbuffer.entered);
        sums = sum_kernel(&columns, &domain, &between, &sums);
        assert!(between.iter().chain(&sums).all(|light| light.is_finite()), "{rows:?}");
    }
    let picture = shade_kernel(&gbuffer, &sums, &profile, &blocks, &stage.reflections(), BACKGROUND);
    assert!(picture.iter().any(|pixel| *pixel != BACKGROUND), "the ball is in the picture");
}
