//! Cases: techniques that are timed against each other, frame by frame.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use glam::{Quat, Vec3};
use subsurf_cli::program::progress::Bars;
use subsurf_encoder::Progress as _;
use subsurf_runtime::{Gpu, Purpose, RuntimeOptions};
use subsurf_scene::{LightShape, Mesh, Scene};
use subsurf_viewer::{GpuAsset, RenderRequest, RenderSession};

/// Case of a benchmark: one technique on one mesh, on a device.
pub(super) struct BenchCase {
    session: RenderSession,
    pub(super) times: Times,
}

/// Times of frames in ms, and bytes on the device.
pub(super) struct Times {
    /// Times of whole frames in ms.
    pub(super) frames: Vec<f64>,
    /// Times of each pass in ms, by its name.
    pub(super) passes: BTreeMap<&'static str, Vec<f64>>,
    /// Names of passes in the order of the frame.
    pub(super) order: Vec<&'static str>,
    /// Whether the device took the times of the passes; else they were waited for one by one.
    pub(super) is_by_device: bool,
    /// Bytes on the device by their purpose.
    pub(super) bytes: [(Purpose, u64); Purpose::ALL.len()],
}

impl Times {
    /// Bytes of the material, and of everything but the material and the mesh.
    pub(super) fn bytes_of_material_and_buffers(&self) -> [u64; 2] {
        let of = |purposes: &[Purpose]| {
            self.bytes.iter().filter(|(purpose, _)| purposes.contains(purpose)).map(|(_, bytes)| bytes).sum()
        };
        [of(&[Purpose::Material]), of(&[Purpose::LightView, Purpose::Frame, Purpose::Other])]
    }
}

impl BenchCase {
    /// Case of what `upload` brings to the device.
    pub(super) fn new(
        gpu: &Gpu,
        upload: impl FnOnce() -> subsurf_viewer::Result<GpuAsset>,
        mesh: &Mesh,
        size: [u32; 2],
    ) -> anyhow::Result<Self> {
        let options = RuntimeOptions::default();
        let of = |purpose| gpu.ledger().bytes_of(purpose);
        let before = Purpose::ALL.map(of);
        let asset = upload()?;
        let session = RenderSession::new(gpu, asset, &RenderRequest::usual(size).scene(mesh), size, options)?;
        let times = Times {
            frames: Vec::new(),
            passes: BTreeMap::new(),
            order: Vec::new(),
            is_by_device: false,
            bytes: std::array::from_fn(|k| (Purpose::ALL[k], of(Purpose::ALL[k]) - before[k])),
        };
        Ok(Self { session, times })
    }

    /// Its picture of a scene of the size that it was made for.
    pub(super) fn picture(&mut self, gpu: &Gpu, scene: &Scene) -> anyhow::Result<Vec<[u8; 3]>> {
        Ok(self.session.picture(gpu, scene)?)
    }

    fn draw(&mut self, gpu: &Gpu, scene: &Scene) -> anyhow::Result<f64> {
        let begin = Instant::now();
        self.session
            .with(scene, |renderer, frame, input, picture| renderer.draw_now(gpu, frame, input, &picture.target()))?;
        gpu.finish()?;
        Ok(ms(begin.elapsed()))
    }

    fn draw_timed(&mut self, gpu: &Gpu, scene: &Scene) -> anyhow::Result<()> {
        let times = self
            .session
            .with(scene, |renderer, frame, input, picture| renderer.draw_timed(gpu, frame, input, &picture.target()))?;
        self.times.is_by_device = times.is_by_device;
        self.times.order = times.passes.iter().map(|(name, _)| *name).collect();
        for (name, time) in times.passes {
            self.times.passes.entry(name).or_default().push(ms(time));
        }
        Ok(())
    }
}

/// Draws `frames` frames of each under a light that turns, after one that does not count, and as many again whose passes are timed.
/// Cases take turns: what else the machine does falls on all of them alike. If `frames` is 0, the first one counts.
pub(super) fn run(
    gpu: &Gpu,
    cases: &mut [BenchCase],
    mesh: &Mesh,
    size: [u32; 2],
    frames: usize,
) -> anyhow::Result<()> {
    let mut scene = RenderRequest::usual(size).scene(mesh);
    scene.camera.exposure = 0.5;
    let bars = Bars::new();
    bars.begin("frames", ((2 * frames + 1) * cases.len()) as u64);
    for number in 0..=frames {
        turn(&mut scene);
        for case in &mut *cases {
            let time = case.draw(gpu, &scene)?;
            // Drivers compile at the first frame.
            if number > 0 || frames == 0 {
                case.times.frames.push(time);
            }
            bars.advance(1);
        }
    }
    for _ in 0..frames {
        turn(&mut scene);
        for case in &mut *cases {
            case.draw_timed(gpu, &scene)?;
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
