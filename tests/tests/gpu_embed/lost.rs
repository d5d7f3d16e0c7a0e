//! Devices that are lost in the middle of a host's frame.

use glam::Vec3;
use subsurf_runtime::wgpu::{self, Backends};
use subsurf_runtime::{Error, Input, Object};
use subsurf_scene::{Environment, Lighting};

use super::application;
use super::stage::{SIZE, Stage, sun};

/// The device is lost between recording and submission, and before a frame is recorded: an error, never a panic; and a new
/// device draws the same picture from the same bytes.
#[test]
fn a_device_is_lost_in_the_middle_of_a_frame() {
    for backends in [Backends::VULKAN, Backends::GL] {
        let stage = Stage::open(backends);
        let objects = [stage.jade(), stage.leather(), Object { material: &stage.splats, ..stage.jade() }];
        let lights = [sun()];
        let before = stage.draw(application::view(), &objects, &lights, true);

        let environment = Environment::uniform([0.35, 0.4, 0.5]);
        let lighting = Lighting { lights: &lights, environment: &environment, reference_mm: Vec3::ZERO };
        let input = Input { view: application::view(), exposure: 1.0, lighting, shadow_maps: &[], objects: &objects };
        let mut frame = stage.renderer.prepare(&stage.gpu, &input, SIZE).unwrap();
        let view = stage.app.colour.create_view(&wgpu::TextureViewDescriptor::default());
        let mut draw = |encoder: &mut wgpu::CommandEncoder| {
            stage.renderer.draw(&stage.gpu, encoder, &mut frame, &input, &stage.over(&view))
        };
        let mut encoder = stage.app.device.create_command_encoder(&Default::default());
        draw(&mut encoder).unwrap();
        stage.app.device.destroy();
        stage.app.queue.submit([encoder.finish()]);
        assert!(matches!(stage.gpu.finish(), Err(Error::Device(_))), "{backends:?}: waiting for what was recorded");

        let mut encoder = stage.app.device.create_command_encoder(&Default::default());
        assert!(matches!(draw(&mut encoder), Err(Error::Device(_))), "{backends:?}: the next frame");
        stage.app.queue.submit([encoder.finish()]);
        let anew = stage.renderer.prepare(&stage.gpu, &input, SIZE);
        assert!(matches!(anew, Err(Error::Device(_))), "{backends:?}: room for another frame");

        let other = Stage::open(backends);
        let objects = [other.jade(), other.leather(), Object { material: &other.splats, ..other.jade() }];
        assert!(other.draw(application::view(), &objects, &lights, true) == before, "{backends:?}: the same picture");
    }
}
