//! `subsurf render`: a picture of a material, flat or on a mesh.

mod asset;
mod btf;
mod btf_args;
mod exposure;
mod mesh;
mod options;
mod patch;

use std::path::{Path, PathBuf};
use std::time::Instant;

use image::RgbImage;
use serde_json::{Map, Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::metrics::bssrdf::Light;
use subsurf_runtime::TargetFormat;
use subsurf_scene::Mesh;
use subsurf_viewer::{DrawnMaterial, RenderRequest, Scattering, Set, human, parse, read};

use crate::devices::{self, BackendArg, check_picture};
use crate::options::{MeshArgs, Size, UpArg};
use crate::outln;
use crate::picture::{check_picture_target, montage, write_picture};
use crate::program::failure::bad_request;
use asset::{draw_kernel, draw_transfer};
use btf::draw_btf;
use options::{AnglesArg, LightArg};

pub(crate) use btf_args::{BtfArgs, Copies};
pub(crate) use mesh::draw_mesh;
pub(crate) use options::{MappingArg, SceneArg, TechniqueArg, read_environment};
pub(crate) use patch::{draw_patch, patch_irradiance};

/// Draw a material: a translucent one flat or on a mesh, by the reference technique or by a fast one; a BTF or a kernel on a mesh; a
/// transfer on the mesh that it is of.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES, group(clap::ArgGroup::new("surface").multiple(true)))]
pub(crate) struct Args {
    /// The .subsurf file
    file: PathBuf,
    /// The picture to write (.png, .jpg, .tif, .webp, .bmp, .tga)
    #[arg(long, short)]
    output: PathBuf,
    /// Draw it on this mesh: a file (.obj, .ply, .stl, .off, .glb, .gltf), or one of knot, bowl, drapery, relief, sphere,
    /// torus; a BTF, a kernel, and anything in a --scene, on the knot if not given
    #[arg(long, value_name = "FILE|SHAPE", group = "surface")]
    mesh: Option<PathBuf>,
    /// What stands around the mesh, and from where both are lit and seen; studio if not given
    #[arg(long, value_enum, value_name = "NAME", group = "surface")]
    scene: Option<SceneArg>,
    /// Longest side of the mesh in mm: a translucent material has its real size
    #[arg(long, default_value_t = 60.0, value_name = "MM", requires = "surface")]
    extent: f32,
    /// How light scatters in a translucent material; of several, separated by commas, the pictures stand side by side, all of the
    /// exposure of the first; gather if not given, kernel for kernels, transfer for transfers
    #[arg(long, value_enum, value_delimiter = ',')]
    technique: Vec<TechniqueArg>,
    /// Light from all around: an equirectangular picture (.hdr, .exr, .png, .jpg ..); the scene's if not given
    #[arg(long, value_name = "FILE", requires = "surface")]
    environment: Option<PathBuf>,
    /// How rough the coat of a translucent material is that reflects it, 0 to 1; 0.25 if not given
    #[arg(long, requires = "surface")]
    roughness: Option<f32>,
    /// Which way is up in the mesh
    #[arg(long, value_enum, default_value = "y", requires = "surface")]
    up: UpArg,
    /// Where the material lies on the mesh
    #[arg(long, value_enum, default_value = "auto", requires = "surface")]
    mapping: MappingArg,
    /// From where the mesh is seen: degrees around, degrees up; 30,15 in the studio
    #[arg(long, value_name = "AROUND,UP", requires = "surface", allow_hyphen_values = true)]
    view: Option<AnglesArg>,
    /// uniform, disc or line on a patch; a direction X,Y,Z towards the light on a mesh; the scene's if not given
    #[arg(long, value_name = "LIGHT", allow_hyphen_values = true)]
    light: Option<LightArg>,
    /// What to multiply light by before tone mapping; chosen from the picture if not given
    #[arg(long)]
    exposure: Option<f32>,
    /// Pixels of the picture, of each if there are several
    #[arg(long, default_value = "960x720", value_name = "WxH")]
    size: Size,
    /// What draws
    #[arg(long, value_enum, default_value = "auto")]
    backend: BackendArg,
    /// Report as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    btf: BtfArgs,
}

const EXAMPLES: &str = "\
Examples:
  subsurf render jade.subsurf -o patch.png --light line
  subsurf render jade.subsurf -o bunny.png --mesh bunny.ply --technique separable
  subsurf render jade.subsurf -o jade.png --scene hero --technique separable
  subsurf render jade.subsurf -o both.png --scene hero --mesh bowl --technique separable,gather
  subsurf render knot.subsurf -o knot.png --mesh knot                    what subsurf transfer has precomputed
  subsurf render leather.subsurf -o leather.png
  subsurf render leather.subsurf -o sofa.png --mesh sofa.glb --repeat 8 --environment room.hdr --samples 32
  subsurf render leather.subsurf -o both.png --images leather/        the file and the images, side by side";

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    check_picture_target(&args.output)?;
    check_picture(args.size.0)?;
    args.btf.check()?;
    if let Some(exposure) = args.exposure
        && !(exposure.is_finite() && exposure > 0.0)
    {
        return Err(bad_request(format!("--exposure is {exposure}; it must be positive")));
    }
    if let Some(roughness) = args.roughness.filter(|roughness| !(0.0..=1.0).contains(roughness)) {
        return Err(bad_request(format!("--roughness is {roughness}; it must be between 0 and 1")));
    }
    let bytes = read(&args.file)?;
    let start = Instant::now();
    let (Drawing { picture, exposure, facts }, device) = match parse(&args.file, &bytes)? {
        DrawnMaterial::Bssrdf(material) => draw_bssrdf(args, &material)?,
        DrawnMaterial::Btf(btf) => {
            args.refuse_scattering()?;
            let gpu = match args.btf.images {
                Some(_) => Some(args.backend.open_device("--images are drawn by devices only")?),
                None => args.backend.open()?,
            };
            let mesh = args.load_mesh(args.mesh.as_deref().unwrap_or(Path::new(USUAL_SHAPE)))?;
            (draw_btf(gpu.as_ref(), &btf, &mesh, &args.btf, &args.request()?)?, devices::name(gpu.as_ref()))
        }
        DrawnMaterial::Kernel(kernel) => {
            args.btf.expect_none()?;
            if args.technique.iter().any(|technique| *technique != TechniqueArg::Kernel) {
                return Err(bad_request("the file is a kernel, which is drawn by --technique kernel only"));
            }
            let gpu = args.backend.open_device("kernels are drawn by devices only")?;
            let mesh = args.load_mesh(args.mesh.as_deref().unwrap_or(Path::new(USUAL_SHAPE)))?;
            (draw_kernel(&gpu, &kernel, &mesh, &args.request()?)?, devices::name(Some(&gpu)))
        }
        DrawnMaterial::Transfer(transfer) => {
            args.refuse_for_transfer()?;
            let gpu = args.backend.open_device("transfers are drawn by devices only")?;
            let path =
                args.mesh.as_deref().ok_or_else(|| bad_request("a transfer is of one mesh: name it by --mesh"))?;
            (draw_transfer(&gpu, &transfer, &args.load_mesh(path)?, &args.request()?)?, devices::name(Some(&gpu)))
        }
    };
    write_picture(&args.output, &picture)?;
    let seconds = start.elapsed().as_secs_f64();
    if args.json {
        let mut value = json!({ "file": args.output, "device": device, "exposure": exposure, "seconds": seconds });
        if let Some(value) = value.as_object_mut() {
            value.extend(facts);
        }
        outln!("{value:#}");
    } else {
        outln!("{}: drawn by {device} in {seconds:.1} s", args.output.display());
        for (fact, what) in [("gpu_bytes", "the material takes"), ("images_gpu_bytes", "its images take")] {
            if let Some(bytes) = facts.get(fact).and_then(Value::as_u64) {
                outln!("  {what} {} on the device", human(bytes));
            }
        }
    }
    Ok(())
}

/// What a BTF, a kernel, or whatever stands in a set, is drawn on if nothing is said.
const USUAL_SHAPE: &str = "knot";

/// A picture, and what is said about it.
pub(crate) struct Drawing {
    pub(crate) picture: RgbImage,
    /// Factor on radiances before they became display values.
    exposure: f32,
    facts: Map<String, Value>,
}

/// A translucent material, flat or on a mesh, by each technique that is asked for; and what drew it.
fn draw_bssrdf(args: &Args, material: &Bssrdf<'_>) -> anyhow::Result<(Drawing, String)> {
    args.btf.expect_none()?;
    let techniques = args.technique.iter().map(|technique| technique.scattering());
    let mut techniques = techniques.collect::<anyhow::Result<Vec<Scattering>>>()?;
    if techniques.is_empty() {
        techniques.push(Scattering::Gather);
    }
    let mesh = match (args.mesh.as_deref(), args.scene) {
        (None, None) => None,
        (shape, _) => Some(args.load_mesh(shape.unwrap_or(Path::new(USUAL_SHAPE)))?),
    };
    let blurs = |technique: &Scattering| !matches!(technique, Scattering::Gather | Scattering::Splat);
    let mut gpu = if mesh.is_some() && techniques.iter().any(|technique| *technique != Scattering::Gather) {
        Some(args.backend.open_device("the CPU draws meshes by --technique gather only")?)
    } else {
        args.backend.open()?
    };
    let is_short_of_halves = gpu.as_ref().is_some_and(|gpu| gpu.target_format() == TargetFormat::Packed);
    if is_short_of_halves && techniques.iter().any(blurs) && mesh.is_none() && args.backend == BackendArg::Auto {
        // The CPU does what the device cannot.
        gpu = None;
    }
    let gpu = gpu.as_ref();
    let light = match (&mesh, args.light) {
        (None, Some(LightArg::Pattern(light))) => light,
        (None, Some(LightArg::Direction(_))) => {
            return Err(bad_request("--light X,Y,Z is for meshes; on a patch it is uniform, disc or line"));
        }
        _ => Light::Disc,
    };
    let mut on_mesh = match mesh {
        Some(mesh) => Some((mesh, args.request()?)),
        None => None,
    };
    // One after the other, all by the exposure of the first.
    let mut draw = |technique, exposure| match &mut on_mesh {
        None => draw_patch(gpu, material, technique, light, args.size.0, exposure),
        Some((mesh, request)) => {
            request.exposure = exposure;
            draw_mesh(gpu, material, mesh, args.mapping.into(), technique, request)
        }
    };
    let mut drawing = draw(techniques[0], args.exposure)?;
    let mut pictures = vec![drawing.picture];
    for technique in &techniques[1..] {
        pictures.push(draw(*technique, Some(drawing.exposure))?.picture);
    }
    drawing.picture = match pictures.len() {
        1 => pictures.swap_remove(0),
        _ => montage(&[pictures]),
    };
    Ok((drawing, devices::name(gpu)))
}

impl Args {
    /// The mesh of a file or a shape; what was changed or left out of it is said.
    fn load_mesh(&self, path: &Path) -> anyhow::Result<Mesh> {
        Ok(MeshArgs { extent: self.extent, up: self.up }.load(path)?)
    }

    /// The picture of a mesh that is asked for.
    fn request(&self) -> anyhow::Result<RenderRequest> {
        let usual = RenderRequest::of(self.scene.map(Set::from).unwrap_or_default(), self.size.0);
        Ok(RenderRequest {
            direction: match self.light {
                None => usual.direction,
                Some(LightArg::Direction(direction)) => direction,
                Some(LightArg::Pattern(_)) => {
                    return Err(bad_request(
                        "--light uniform, disc and line are for patches; on a mesh it is a direction X,Y,Z",
                    ));
                }
            },
            environment: match &self.environment {
                Some(path) => read_environment(path)?,
                None => usual.environment,
            },
            roughness: self.roughness.unwrap_or(usual.roughness),
            angles: self.view.map_or(usual.angles, |AnglesArg(angles)| angles),
            exposure: self.exposure,
            ..usual
        })
    }

    /// Refuses options that say nothing to what is precomputed for a mesh.
    fn refuse_for_transfer(&self) -> anyhow::Result<()> {
        self.btf.expect_none()?;
        if self.technique.iter().any(|technique| *technique != TechniqueArg::Transfer) {
            return Err(bad_request("the file is a transfer, which is drawn by --technique transfer only"));
        }
        if self.technique.len() > 1 {
            return Err(bad_request("a transfer is drawn in one way: --technique once, or not at all"));
        }
        if self.scene == Some(SceneArg::Hero) {
            return Err(bad_request("the file is of a mesh alone, and --scene hero stands it on a plate"));
        }
        Ok(())
    }

    /// Refuses options that say nothing to a BTF.
    fn refuse_scattering(&self) -> anyhow::Result<()> {
        let given = [
            ("--technique", !self.technique.is_empty()),
            ("--roughness", self.roughness.is_some()),
            ("--mapping box", self.mapping == MappingArg::Box),
        ];
        match given.iter().find(|(_, is_given)| *is_given) {
            Some((name, _)) => Err(bad_request(format!("{name} is for translucent materials; this file is a BTF"))),
            None => Ok(()),
        }
    }
}
