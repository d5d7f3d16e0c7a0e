//! `subsurf view`: a window in which a material is turned, lit and compared.

mod app;
mod compose;
mod controls;
mod loader;
mod orbit;
mod painter;
mod panel;
mod session;
mod stage;
mod studio;
mod subject;
mod times;
mod window;

use std::path::PathBuf;
use std::sync::Arc;

use subsurf_encoder::check_target;
use subsurf_runtime::{Backend, BtfOptions, RuntimeOptions};
use winit::event_loop::EventLoop;

use crate::devices::check_picture;
use crate::failure::{NoDisplay, bad_request};
use crate::mesh::Up;
use crate::options::{ByteCount, Size};
use crate::render::{BtfArgs, MappingArg, PathArg, ROUGHNESS, Shot, read_environment};
use app::{App, Wishes};
use loader::{Answer, Loader};
use panel::Settings;
use session::Session;
use studio::Studio;
use subject::{Reading, Subject};

/// Look at materials on a mesh in a window: turn it, drag the light, switch paths, see the error; BTFs beside their images.
#[derive(clap::Args)]
#[command(after_help = controls::KEYS)]
pub(crate) struct Args {
    /// The .subsurf files; N goes from one to the next
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// A mesh (.obj, .ply, .glb, .gltf), or one of knot, bowl, drapery, relief, sphere, torus
    #[arg(long, value_name = "FILE|SHAPE", default_value = "knot")]
    mesh: PathBuf,
    /// Longest side of the mesh in mm: the material has its real size
    #[arg(long, default_value_t = 60.0, value_name = "MM")]
    extent: f32,
    /// Which way is up in the mesh
    #[arg(long, value_enum, default_value = "y")]
    up: Up,
    /// Where the material lies on the mesh
    #[arg(long, value_enum, default_value = "auto")]
    mapping: MappingArg,
    /// How light scatters in translucent materials, to begin with
    #[arg(long, value_enum, default_value = "separable")]
    path: PathArg,
    /// Begin with ten times the difference to the gather, or of a BTF to its images
    #[arg(long)]
    error: bool,
    /// Shift the taps of the separable path from pixel to pixel: grain instead of bands
    #[arg(long)]
    jitter: bool,
    /// Light from all around: an equirectangular picture, .hdr or .png
    #[arg(long, value_name = "FILE")]
    environment: Option<PathBuf>,
    /// Pixels of the window
    #[arg(long, default_value = "1280x800", value_name = "WxH")]
    size: Size,
    /// Most memory on the device, such as 24MB; views and maps become coarser until everything fits
    #[arg(long, value_name = "BYTES")]
    budget: Option<ByteCount>,
    /// What draws
    #[arg(long, value_enum, default_value = "auto")]
    backend: Api,
    /// Write what the window shows to this PNG, panel included, and end
    #[arg(long, value_name = "FILE")]
    screenshot: Option<PathBuf>,
    /// For tests: lose the device after so many frames
    #[arg(long, hide = true, value_name = "FRAMES")]
    lose_device_after: Option<u32>,
    #[command(flatten)]
    btf: BtfArgs,
}

/// What draws to a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Api {
    /// The first of Vulkan and OpenGL ES that works
    Auto,
    /// Vulkan
    Vulkan,
    /// OpenGL ES
    Gl,
}

/// What other threads tell the window.
#[allow(clippy::large_enum_variant, reason = "a few in flight at a time")]
enum Notice {
    Computed(Answer),
    /// Of the device of this number.
    DeviceLost {
        number: u32,
        reason: String,
    },
    DeviceError(String),
}

/// Samples to a pixel: edges are smooth.
const SAMPLES: u32 = 4;
/// Samples of the environment to a pixel of a BTF, so that it can be turned.
const BTF_SAMPLES: u32 = 4;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    check_picture(args.size.0)?;
    if let Some(path) = &args.screenshot {
        check_target(path)?;
    }
    if !(args.extent.is_finite() && args.extent > 0.0) {
        return Err(bad_request(format!("--extent is {} mm; it must be positive", args.extent)));
    }
    args.btf.check()?;
    let btf = Arc::new(args.btf.clone());
    let subject = Subject::open(&args.files, &args.mesh, Reading { extent_mm: args.extent, up: args.up }, &btf)?;
    let environment = match &args.environment {
        Some(path) => read_environment(path)?,
        None => Shot::usual(args.size.0).environment,
    };
    let events = EventLoop::<Notice>::with_user_event().build().map_err(|error| {
        // Where in winit it happened helps nobody.
        let text = error.to_string();
        let reason = text.rsplit(": ").next().unwrap_or(&text).trim_end_matches('.');
        NoDisplay(format!(
            "no display to open a window on ({reason}); log in to a desktop session, or draw to a file: subsurf render"
        ))
    })?;
    let proxy = events.create_proxy();
    let budget_bytes = args.budget.map(|budget| budget.0);
    let session = Session {
        studio: Studio::of(&subject.mesh, &environment, args.size.0),
        subject,
        settings: Settings {
            path: args.path,
            material: 0,
            roughness: ROUGHNESS,
            exposure: 1.0,
            shows_error: args.error,
            splits: args.btf.images.is_some() && !args.error,
            turns_light: false,
            is_open: true,
        },
        loader: Loader::new(proxy.clone()),
        mapping: args.mapping,
        budget_bytes,
        times: times::Times::default(),
        message: None,
        failure: None,
        refused: Vec::new(),
        is_stale: true,
        exposes: true,
    };
    let wishes = Wishes {
        backends: match args.backend {
            Api::Auto => Backend::ALL.to_vec(),
            Api::Vulkan => vec![Backend::Vulkan],
            Api::Gl => vec![Backend::Gl],
        },
        options: RuntimeOptions {
            budget_bytes,
            samples: SAMPLES,
            jitters: args.jitter,
            btf: args.btf.options(BtfOptions { samples: BTF_SAMPLES, ..BtfOptions::default() }),
            ..RuntimeOptions::default()
        },
        size: args.size.0,
        screenshot: args.screenshot.clone(),
        loses_device_after: args.lose_device_after,
    };
    let mut app = App::new(wishes, session, proxy);
    events.run_app(&mut app).map_err(|error| NoDisplay(format!("the display failed: {error}")))?;
    app.outcome()
}
