//! Paths that are timed against each other, frame by frame.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use glam::{Quat, Vec3};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::Progress as _;
use subsurf_runtime::scene::{LightShape, Mesh, Scene};
use subsurf_runtime::{Gpu, PictureTarget, RuntimeOptions};

use crate::progress::Bars;
use crate::render::{Ingredients, Ready, Shot};

/// One path on one mesh, on the device.
pub(super) struct Course {
    ready: Ready,
    target: PictureTarget,
    pub(super) times: Times,
}

/// Milliseconds of frames, and what they took on the device.
pub(super) struct Times {
    /// Whole frames.
    pub(super) frames: Vec<f64>,
    /// Each pass by itself.
    pub(super) passes: BTreeMap<&'static str, Vec<f64>>,
    /// In the order of the frame.
    pub(super) order: Vec<&'static str>,
    pub(super) material_bytes: u64,
    /// Of everything but the material and the mesh.
    pub(super) buffer_bytes: u64,
}

impl Course {
    pub(super) fn new(
        gpu: &Gpu,
        ingredients: &Ingredients,
        material: &Bssrdf<'_>,
        mesh: &Mesh,
        size: [u32; 2],
    ) -> anyhow::Result<Self> {
        let options = RuntimeOptions::default();
        let before = gpu.ledger().bytes();
        let prepared = ingredients.upload(gpu, material, mesh)?;
        let [material_bytes, mesh_bytes] = [prepared.material_bytes(), prepared.mesh_bytes()];
        let ready = Ready::new(gpu, prepared, &Shot::usual(size).scene(mesh), size, options)?;
        let target = gpu.target(size, options.format)?;
        let times = Times {
            frames: Vec::new(),
            passes: BTreeMap::new(),
            order: Vec::new(),
            material_bytes,
            buffer_bytes: gpu.ledger().bytes() - before - material_bytes - mesh_bytes,
        };
        Ok(Self { ready, target, times })
    }

    /// Its picture of a scene of the size that it was made for.
    pub(super) fn picture(&mut self, gpu: &Gpu, scene: &Scene) -> anyhow::Result<Vec<[u8; 3]>> {
        self.ready.picture(gpu, scene)
    }

    fn draw(&mut self, gpu: &Gpu, scene: &Scene) -> anyhow::Result<f64> {
        let Ready { prepared, renderer, frame } = &mut self.ready;
        let begin = Instant::now();
        renderer.draw(gpu, frame, &prepared.model(), scene, self.target.view())?;
        gpu.finish()?;
        Ok(ms(begin.elapsed()))
    }

    fn draw_timed(&mut self, gpu: &Gpu, scene: &Scene) -> anyhow::Result<()> {
        let Ready { prepared, renderer, frame } = &mut self.ready;
        let passes = renderer.draw_timed(gpu, frame, &prepared.model(), scene, self.target.view())?;
        self.times.order = passes.iter().map(|(name, _)| *name).collect();
        for (name, time) in passes {
            self.times.passes.entry(name).or_default().push(ms(time));
        }
        Ok(())
    }
}

/// Draws `frames` frames of each under a light that turns, after one that does not count, and as many again pass by pass.
/// Courses take turns: what else the machine does falls on all of them alike. If `frames` is 0, the first one counts.
pub(super) fn run(gpu: &Gpu, courses: &mut [Course], mesh: &Mesh, size: [u32; 2], frames: usize) -> anyhow::Result<()> {
    let mut scene = Shot::usual(size).scene(mesh);
    scene.view.exposure = 0.5;
    let bars = Bars::new();
    bars.begin("frames", ((2 * frames + 1) * courses.len()) as u64);
    for number in 0..=frames {
        turn(&mut scene);
        for course in &mut *courses {
            let time = course.draw(gpu, &scene)?;
            // Drivers compile at the first frame.
            if number > 0 || frames == 0 {
                course.times.frames.push(time);
            }
            bars.advance(1);
        }
    }
    for _ in 0..frames {
        turn(&mut scene);
        for course in &mut *courses {
            course.draw_timed(gpu, &scene)?;
            bars.advance(1);
        }
    }
    Ok(())
}

fn ms(time: Duration) -> f64 {
    1e3 * time.as_secs_f64()
}

/// Turns the lights by a fifth of a degree.
fn turn(scene: &mut Scene) {
    for light in &mut scene.lights {
        if let LightShape::Directional { towards } = &mut light.shape {
            *towards = Quat::from_axis_angle(Vec3::Y, 0.2_f32.to_radians()) * *towards;
        }
    }
}
