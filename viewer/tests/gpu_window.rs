//! The window draws, and survives the loss of its device.

#![cfg(target_os = "linux")]

use subsurf_decoder::bssrdf::Addressing;
use subsurf_encoder::synthetic::NestedShape;
use subsurf_runtime::{Backend, BtfOptions, Gpu, RuntimeOptions};
use subsurf_scene::{Environment, UpAxis, torus};
use subsurf_tests::drawable;
use subsurf_tests::meshes::write_obj;
use subsurf_tests::program::under_display;
use subsurf_viewer::{Config, Error, Event, Host, MappingChoice, Picture, Scattering, Set, Viewer, options};
use winit::event_loop::EventLoop;
use winit::platform::x11::EventLoopBuilderExtX11 as _;

const TEST: &str = "a_window_draws_and_survives_the_loss_of_its_device";
/// Says to this program that it runs under a display, and what it is to draw.
const CASE: &str = "SUBSURF_VIEWER_CASE";
const SIZE: [u32; 2] = [560, 240];

/// Destroys the device after three frames.
#[derive(Default)]
struct Saboteur {
    frames: u32,
    recovered: Vec<String>,
    captured: Option<Picture>,
}

impl Host for Saboteur {
    fn save(&mut self, _: &str, _: &Picture) -> Result<String, String> {
        Err("nobody asked".to_owned())
    }

    fn capture(&mut self, picture: &Picture, _: &str) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        self.captured = Some(Picture { size: picture.size, pixels: picture.pixels.clone() });
        Ok(())
    }

    fn recovered(&mut self, reason: &str) {
        self.recovered.push(reason.to_owned());
    }

    fn presented(&mut self, frame: u32, gpu: &Gpu) {
        self.frames = frame;
        if frame == 3 {
            gpu.device().destroy();
        }
    }
}

fn draw(bytes: &[u8], backend: Backend) {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("material.subsurf");
    std::fs::write(&file, bytes).unwrap();
    let mesh = folder.path().join("torus.obj");
    write_obj(&mesh, &torus(9.0, 4.0, 12));
    let viewer = Viewer::open(Config {
        files: vec![file],
        material: None,
        mesh,
        extent_mm: 60.0,
        up: UpAxis::Y,
        set: Set::Studio,
        mapping: MappingChoice::Auto,
        technique: Scattering::Separable,
        shows_error: false,
        repeats: None,
        images: None,
        make_kernel: None,
        environment: Environment::studio(),
        // Small, for a processor may have to draw it.
        size: SIZE,
        backends: vec![backend],
        options: RuntimeOptions {
            budget_bytes: Some(12_000_000),
            btf: BtfOptions { samples: 1, ..BtfOptions::default() },
            ..options()
        },
        captures: true,
    })
    .unwrap();
    let events = EventLoop::<Event>::with_user_event().with_any_thread(true).build().unwrap();
    let mut host = Saboteur::default();
    match viewer.run(events, &mut host) {
        Err(Error::NoDisplay(reason)) => println!("skipped: {reason}"),
        Err(Error::Runtime(error @ subsurf_runtime::Error::NoDevice { .. })) => println!("skipped: {error}"),
        result => {
            result.unwrap();
            assert_eq!(host.recovered.len(), 1, "the device was lost once: {:?}", host.recovered);
            assert!(host.frames > 3, "frames go on");
            let picture = host.captured.expect("a picture");
            assert_eq!((picture.size, picture.pixels.len()), (SIZE, 560 * 240), "a picture of the whole window");
            // Right of the panel: the torus before a dark background.
            let is_bright =
                |(k, pixel): &(usize, &[u8; 3])| k % SIZE[0] as usize > 330 && pixel.iter().all(|c| *c > 90);
            assert!(picture.pixels.iter().enumerate().filter(is_bright).count() > 500, "the torus is not seen");
        }
    }
}

#[test]
fn a_window_draws_and_survives_the_loss_of_its_device() {
    if let Ok(case) = std::env::var(CASE) {
        let (material, backend) = case.split_once(' ').unwrap();
        let bytes = match material {
            "btf" => NestedShape::small().database(2).to_bytes(),
            _ => drawable([9, 7], 2, Addressing::Clamp),
        };
        return draw(&bytes, if backend == "gl" { Backend::Gl } else { Backend::Vulkan });
    }
    let program = std::env::current_exe().unwrap();
    for case in ["bssrdf vulkan", "bssrdf gl", "btf vulkan", "btf gl"] {
        let run = under_display(program.to_str().unwrap(), |test| {
            // As `subsurf` has it: OpenGL ES 3.0.
            test.args([TEST, "--exact", "--nocapture"]).env(CASE, case);
            test.env("MESA_GL_VERSION_OVERRIDE", "3.0").env("MESA_GLES_VERSION_OVERRIDE", "3.0");
        });
        let Some(run) = run else {
            println!("skipped: there is no xvfb-run; apt-get install xvfb");
            return;
        };
        assert!(run.code == 0 && run.out.contains("1 passed"), "{case}: {}{}", run.out, run.err);
        println!("{case}: {}", run.out.lines().filter(|line| line.starts_with("skipped")).collect::<String>());
    }
}
