//! `subsurf devices`: what there is to draw with.

use subsurf_encoder::memory;
use subsurf_runtime::{Backend, Gpu, devices};

use crate::outln;
use crate::program::failure::bad_request;

pub(crate) fn run() -> anyhow::Result<()> {
    let mut opened = 0;
    let mut failed = None;
    for backend in Backend::ALL {
        for info in devices(backend) {
            outln!("{backend:<10} {} ({:?}; {} {})", info.name, info.device_type, info.driver, info.driver_info);
        }
        match Gpu::open(backend) {
            Ok(_) => opened += 1,
            Err(error) => failed = Some(error),
        }
    }
    match failed {
        Some(error) if opened == 0 => {
            Err(anyhow::Error::new(error)
                .context("nothing to draw with; `subsurf render --backend cpu` needs no driver"))
        }
        _ => Ok(()),
    }
}

/// What draws: a graphics API, or the CPU.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum BackendArg {
    /// The first of this system's APIs that works, or the CPU
    Auto,
    /// Vulkan
    Vulkan,
    /// Metal, on a Mac
    Metal,
    /// Direct3D 12, on Windows
    Dx12,
    /// OpenGL ES
    Gl,
    /// This machine's cores; needs no driver
    Cpu,
}

impl BackendArg {
    /// Graphics APIs to try, in this order; none for the CPU.
    fn backends(self) -> Vec<Backend> {
        match self {
            Self::Auto => Backend::ALL.to_vec(),
            Self::Vulkan => vec![Backend::Vulkan],
            Self::Metal => vec![Backend::Metal],
            Self::Dx12 => vec![Backend::Dx12],
            Self::Gl => vec![Backend::Gl],
            Self::Cpu => Vec::new(),
        }
    }

    /// The device, opened; `None` stands for the CPU.
    pub fn open(self) -> anyhow::Result<Option<Gpu>> {
        match self.first_that_works() {
            Some(Err(error)) if self != Self::Auto => Err(error.into()),
            opened => Ok(opened.and_then(Result::ok)),
        }
    }

    /// A device, opened, for what the CPU does not draw; `why` says so.
    pub(crate) fn open_device(self, why: &str) -> anyhow::Result<Gpu> {
        match self.first_that_works() {
            None => Err(bad_request(format!("{why}: choose another --backend"))),
            Some(Err(error)) if self == Self::Auto => {
                Err(anyhow::Error::new(error).context(format!("{why}, and there is no device")))
            }
            Some(opened) => Ok(opened?),
        }
    }

    /// The first device that opens, or why the last one does not; `None` for the CPU.
    fn first_that_works(self) -> Option<Result<Gpu, subsurf_runtime::Error>> {
        let mut opened = None;
        for backend in self.backends() {
            match opened {
                Some(Ok(_)) => break,
                _ => opened = Some(Gpu::open(backend)),
            }
        }
        opened
    }
}

/// Name of a device for people.
pub fn name(gpu: Option<&Gpu>) -> String {
    gpu.map_or_else(
        || format!("CPU, {} threads", rayon::current_num_threads()),
        |gpu| format!("{} ({:?}, {})", gpu.info().name, gpu.info().backend, gpu.info().driver_info),
    )
}

/// Bytes of memory for a pixel of a picture, which is drawn four times as large: colour, depth and what is read back.
const BYTES_OF_PIXEL: u64 = 4 * 8;

/// Picture sizes that no device takes, or that do not fit into memory, refused before anything is allocated.
pub(crate) fn check_picture(size: [u32; 2]) -> anyhow::Result<()> {
    const LARGEST: u32 = 16_384;
    if size.iter().any(|side| *side > LARGEST) {
        return Err(bad_request(format!("a picture of {} × {} pixels; the limit is {LARGEST}", size[0], size[1])));
    }
    let [width, height] = size.map(u64::from);
    Ok(memory::expect(width * height * BYTES_OF_PIXEL, || format!("a picture of {width} × {height} pixels"))?)
}

/// What drivers read from the environment, unless somebody set it.
const DRIVER_SETTINGS: [(&str, &str); 2] = [
    // Mesa opens desktop GL unless told otherwise; `gl` is to be what a phone has.
    ("MESA_GL_VERSION_OVERRIDE", "3.0"),
    ("MESA_GLES_VERSION_OVERRIDE", "3.0"),
];

/// Settles drivers before the first of them is loaded.
pub(crate) fn settle_drivers() {
    // Where no desktop session is, libwayland complains on stderr as soon as EGL asks it for a display. A folder to look
    // for one in keeps it quiet.
    let folder = std::env::temp_dir();
    let runtime = ("XDG_RUNTIME_DIR", folder.as_os_str());
    let settings = DRIVER_SETTINGS.map(|(key, value)| (key, value.as_ref()));
    for (key, value) in settings.into_iter().chain([runtime]) {
        if std::env::var_os(key).is_none() {
            // SAFETY: called first in main; no other thread is there to read the environment.
            unsafe { std::env::set_var(key, value) };
        }
    }
}
