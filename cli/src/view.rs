//! `subsurf view`: the door to the viewer's window.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use subsurf_encoder::kernel::{KernelMethod, Options, Profile, encode};
use subsurf_encoder::write_bytes;
use subsurf_runtime::{Backend, RuntimeOptions};
use subsurf_viewer::{
    Artist, BtfImageSet, Config, DrawnMaterial, Error, Host, KEYS, LoadImages, Picture, Scattering, Set, Viewer,
    event_loop, parse, read,
};

use crate::devices::check_picture;
use crate::images::FolderImages;
use crate::options::{ByteCount, Size, UpArg};
use crate::outln;
use crate::picture::{check_picture_target, image, write_picture};
use crate::program::failure::{NoDisplay, bad_request, line};
use crate::render::{BtfArgs, Copies, MappingArg, SceneArg, TechniqueArg, read_environment};

/// Look at materials on a mesh in a window: turn it, drag the light, switch techniques, see the error; BTFs beside their images.
#[derive(clap::Args)]
#[command(after_help = help())]
pub(crate) struct Args {
    /// The .subsurf files; N goes from one to the next
    #[arg(required = true, value_name = "FILE")]
    files: Vec<PathBuf>,
    /// A mesh (.obj, .ply, .stl, .off, .glb, .gltf), or one of knot, bowl, drapery, relief, sphere, torus
    #[arg(long, value_name = "FILE|SHAPE", default_value = "knot")]
    mesh: PathBuf,
    /// Longest side of the mesh in mm: the material has its real size
    #[arg(long, default_value_t = 60.0, value_name = "MM")]
    extent: f32,
    /// Which way is up in the mesh
    #[arg(long, value_enum, default_value = "y")]
    up: UpArg,
    /// What stands around the mesh, and from where both are lit and seen; hero if not given, studio for transfers, which are of a mesh alone
    #[arg(long, value_enum)]
    scene: Option<SceneArg>,
    /// Where the material lies on the mesh
    #[arg(long, value_enum, default_value = "auto")]
    mapping: MappingArg,
    /// How light scatters in translucent materials, to begin with; separable if not given, splat where a file has no basis for it
    #[arg(long, value_enum)]
    technique: Option<TechniqueArg>,
    /// Begin with ten times the difference to the gather, or of a BTF to its images
    #[arg(long)]
    error: bool,
    /// Light from all around: an equirectangular picture (.hdr, .exr, .png, .jpg ..); the scene's if not given
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
    /// Write what the window shows to this picture (.png, .jpg ..), panel included, and end
    #[arg(long, value_name = "FILE")]
    screenshot: Option<PathBuf>,
    #[command(flatten)]
    btf: BtfArgs,
}

/// What draws to a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
enum Api {
    /// The first of this system's APIs that works
    Auto,
    /// Vulkan
    Vulkan,
    /// Metal, on a Mac
    Metal,
    /// Direct3D 12, on Windows
    Dx12,
    /// OpenGL ES
    Gl,
}

/// Keys, examples and exit codes, for `--help`.
fn help() -> String {
    format!("In the window:\n{KEYS}\n\n{EXAMPLES}")
}

const EXAMPLES: &str = "\
Examples:
  subsurf view jade.subsurf onyx.subsurf --mesh bunny.ply
  subsurf view jade.subsurf --budget 16MB --backend gl
  subsurf view jade.subsurf --technique splat --screenshot jade.png
  subsurf view bunny-marble.subsurf --mesh bunny.ply
  subsurf view leather.subsurf --images leather/ --repeat 6

Exit codes: 3 if there is no display or no device that draws to it.";

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    check_picture(args.size.0)?;
    if let Some(path) = &args.screenshot {
        check_picture_target(path)?;
    }
    args.btf.check()?;
    let viewer = Viewer::open(args.config()?)?;
    let events = event_loop().map_err(|error| match error {
        Error::NoDisplay(reason) => anyhow::Error::new(NoDisplay(format!(
            "{reason}; log in to a desktop session, or draw to a file: subsurf render"
        ))),
        error => error.into(),
    })?;
    Ok(viewer.run(events, &mut Files { screenshot: args.screenshot.as_deref() })?)
}

impl Args {
    fn config(&self) -> anyhow::Result<Config> {
        let usual = subsurf_viewer::options();
        let has_transfer = has_transfer(&self.files)?;
        if has_transfer && self.scene == Some(SceneArg::Hero) {
            return Err(bad_request("a transfer is of a mesh alone, and --scene hero stands it on a plate"));
        }
        let usual_scene = if has_transfer { SceneArg::Studio } else { SceneArg::Hero };
        let set = Set::from(self.scene.unwrap_or(usual_scene));
        Ok(Config {
            files: self.files.clone(),
            material: self.btf.material.clone(),
            mesh: self.mesh.clone(),
            extent_mm: self.extent,
            up: self.up.into(),
            set,
            mapping: self.mapping.into(),
            technique: match self.technique {
                Some(TechniqueArg::Kernel) => of_kernels(&self.files)?,
                Some(TechniqueArg::Transfer) if has_transfer => usual_technique(&self.files)?,
                None => usual_technique(&self.files)?,
                Some(technique) => technique.scattering()?,
            },
            shows_error: self.error,
            repeats: self.btf.repeat.map(|Copies(repeats)| repeats),
            images: self.btf.images.clone().map(load_images),
            make_kernel: Some(Arc::new(kernel_of)),
            environment: match &self.environment {
                Some(path) => read_environment(path)?,
                None => set.environment(),
            },
            size: self.size.0,
            backends: match self.backend {
                Api::Auto => Backend::ALL.to_vec(),
                Api::Vulkan => vec![Backend::Vulkan],
                Api::Metal => vec![Backend::Metal],
                Api::Dx12 => vec![Backend::Dx12],
                Api::Gl => vec![Backend::Gl],
            },
            options: RuntimeOptions {
                light_texels: set.light_texels(),
                budget_bytes: self.budget.map(|budget| budget.0),
                btf: self.btf.options(usual.btf),
                ..usual
            },
            captures: self.screenshot.is_some(),
        })
    }
}

/// The fastest technique that all files have what it takes for.
fn usual_technique(files: &[PathBuf]) -> anyhow::Result<Scattering> {
    for path in files {
        let bytes = read(path)?;
        if matches!(parse(path, &bytes)?, DrawnMaterial::Bssrdf(material) if material.basis().is_none()) {
            return Ok(Scattering::Splat);
        }
    }
    Ok(Scattering::Separable)
}

/// Whether a file is precomputed for a mesh.
fn has_transfer(files: &[PathBuf]) -> anyhow::Result<bool> {
    for path in files {
        if matches!(parse(path, &read(path)?)?, DrawnMaterial::Transfer(_)) {
            return Ok(true);
        }
    }
    Ok(false)
}

/// What kernels are opened with, which are drawn in one way; refused if other files are among them.
fn of_kernels(files: &[PathBuf]) -> anyhow::Result<Scattering> {
    for path in files {
        if !matches!(parse(path, &read(path)?)?, DrawnMaterial::Kernel(_)) {
            return Err(bad_request(format!("{}: no kernel; --technique kernel draws nothing else", path.display())));
        }
    }
    Ok(Scattering::Separable)
}

/// Name of a file in this folder that is not taken.
fn free_name(stem: &str, extension: &str) -> PathBuf {
    let mut names = (1..).map(|number: u32| PathBuf::from(format!("{stem}-{number}.{extension}")));
    names.find(|name| !name.exists()).unwrap_or_default()
}

/// Reads a folder of images when they are to be shown.
fn load_images(folder: PathBuf) -> Arc<LoadImages> {
    Arc::new(move || match FolderImages::read(&folder) {
        Ok(images) => Ok(Box::new(images) as Box<dyn BtfImageSet>),
        Err(error) => Err(Error::Images(error.into())),
    })
}

/// Kernel file of an artist's numbers.
fn kernel_of(artist: &Artist) -> Result<Vec<u8>, Error> {
    let two = artist.two_gaussians();
    let make = || {
        let profile = Profile::of_two_gaussians(&two, artist.reflectance)?;
        let method = KernelMethod::TwoGaussians;
        let options = Options {
            method,
            taps: artist.taps.into(),
            two_gaussians: Some(two),
            eta: artist.eta,
            ..Options::default()
        };
        encode(&profile, &options)?.kernel.to_bytes()
    };
    make().map_err(|error: subsurf_encoder::Error| Error::Request(error.to_string()))
}

/// Host of the window: pictures become files, news are printed.
struct Files<'a> {
    screenshot: Option<&'a Path>,
}

impl Host for Files<'_> {
    /// Into this folder, under a name that is not taken.
    fn save(&mut self, stem: &str, picture: &Picture) -> Result<String, String> {
        let path = free_name(stem, "png");
        write_picture(&path, &image(&picture.pixels, picture.size[0])).map_err(|error| line(&error))?;
        outln!("{}", path.display());
        Ok(path.display().to_string())
    }

    /// Likewise.
    fn save_kernel(&mut self, stem: &str, file: &[u8]) -> Result<String, String> {
        let path = free_name(stem, "subsurf");
        write_bytes(&path, file).map_err(|error| error.to_string())?;
        outln!("{}", path.display());
        Ok(path.display().to_string())
    }

    fn capture(&mut self, picture: &Picture, device: &str) -> Result<(), Box<dyn std::error::Error + Send + Sync>> {
        let Some(path) = self.screenshot else {
            return Ok(());
        };
        let [width, height] = picture.size;
        write_picture(path, &image(&picture.pixels, width))?;
        outln!("{}: {width} x {height} pixels, drawn by {device}", path.display());
        Ok(())
    }

    fn recovered(&mut self, reason: &str) {
        eprintln!("subsurf: the device was lost and opened anew ({reason})");
    }
}
