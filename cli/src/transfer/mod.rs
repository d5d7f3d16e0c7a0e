//! `subsurf transfer`: scattering precomputed for the vertices of a mesh.

mod judge;
mod report;

use std::path::PathBuf;
use std::time::Instant;

use clap::builder::PossibleValuesParser;
use subsurf_decoder::Transfer;
use subsurf_encoder::kernel::Profile;
use subsurf_encoder::kernel::profile::shipped;
use subsurf_encoder::rate::Target;
use subsurf_encoder::rate::transfer::{TransferSource, search};
use subsurf_encoder::simulate::diffusion::Medium;
use subsurf_encoder::transfer::{Options, RdTable, Size, encode, fibonacci, precompute};
use subsurf_encoder::{check_target, write_bytes};

pub(crate) use judge::compare;
pub(crate) use report::{bytes_per_vertex, clusters};

use crate::metadata::MetaArgs;
use crate::options::MeshArgs;
use crate::outln;
use crate::program::failure::{bad_request, read_error};
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;
use crate::program::threads;

/// Precompute what leaves a homogeneous material at every vertex of a mesh, for light from any direction.
///
/// Adds up the scattered light of all vertices, with the mesh's shadows, for a set of directions (Hao and Varshney 2004), and writes
/// NAME.subsurf with some six bytes per vertex, and what all vertices share: 50 kB for small meshes, half a megabyte for large ones.
/// Drawing is then a few multiplications for each vertex and light.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub(crate) struct Args {
    /// The mesh: a file (.obj, .ply, .stl, .off, .glb, .gltf), or one of knot, bowl, drapery, relief, sphere, torus
    mesh: PathBuf,
    #[command(flatten)]
    size: MeshArgs,
    /// A measured material (Jensen et al. 2001), by the profile that comes with the command
    #[arg(long, required_unless_present = "profile", conflicts_with = "profile",
        value_parser = PossibleValuesParser::new(shipped::names().collect::<Vec<_>>()))]
    material: Option<String>,
    /// A profile: a .csv of r and R_d, or an .mco file of MCML, as `subsurf kernel` takes them
    #[arg(long, value_name = "FILE")]
    profile: Option<PathBuf>,
    /// The .subsurf file to write
    #[arg(long, short)]
    output: PathBuf,
    /// Choose lights and sizes: the smallest file that is found with at most this e_rms in the worst of 100 views, as a share of the largest q; for example 0.01
    #[arg(long, value_name = "E", conflicts_with_all = ["target_bytes_per_vertex", "lights", "clusters", "components", "bits"])]
    target_error: Option<f64>,
    /// Choose lights and sizes: the best file that is found of at most so many bytes per vertex, all of it counted; for example 20
    #[arg(long, value_name = "B", conflicts_with_all = ["lights", "clusters", "components", "bits"])]
    target_bytes_per_vertex: Option<f64>,
    /// Directions of light, 4 to 1,024: more are closer to the truth in between, and cost side data and time alone
    #[arg(long, default_value_t = 200, value_parser = clap::value_parser!(u16).range(4..=1024))]
    lights: u16,
    /// One channel instead of three: the mean over colours, in fewer bytes and less time; it is tinted when drawn
    #[arg(long)]
    grey: bool,
    /// Clusters of vertices, 1 to 256 [default: one for 400 vertices, from 16 to 256]
    #[arg(long, value_name = "N")]
    clusters: Option<usize>,
    /// Components of a cluster, 1 to 16
    #[arg(long, value_name = "N", default_value_t = 8)]
    components: usize,
    /// Bits of a vertex's coefficients together, up to 120
    #[arg(long, value_name = "N", default_value_t = 40)]
    bits: usize,
    /// Refractive index against air, 1 to 4 [default: that of the material, else 1.3]
    #[arg(long)]
    eta: Option<f32>,
    #[command(flatten)]
    meta: MetaArgs,
    /// Threads to use, at most eight for each core; the file is the same for any number
    #[arg(long)]
    threads: Option<usize>,
}

const EXAMPLES: &str = "\
The file is for this mesh in this size alone. Vertices should be closer than light goes in the material: else there is a warning.

  subsurf transfer bunny.ply --extent 40 --material marble -o bunny.subsurf
  subsurf transfer knot --material skin1 --lights 400 -o knot.subsurf
  subsurf transfer dragon.obj --profile measured.csv --grey -o dragon.subsurf
  subsurf transfer bunny.ply --extent 40 --material marble --target-error 0.02 -o bunny.subsurf
  subsurf compare bunny.ply bunny.subsurf --extent 40                     how far off, in images";

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    threads::set(args.threads)?;
    check_target(&args.output)?;
    let mesh = args.size.load(&args.mesh)?;
    let (profile, usual) = profile(args)?;
    let table = RdTable::of(&profile)?;
    let eta = args.eta.unwrap_or(usual);
    let options = Options { channels: if args.grey { 1 } else { 3 }, eta };
    let (bars, began) = (Bars::new(), Instant::now());
    let bytes = match args.target(mesh.positions.len())? {
        Some(target) => {
            searched(&TransferSource { mesh: &mesh, table: &table, options: &options }, target, args, &bars)?
        }
        None => {
            let clusters = args.clusters.unwrap_or(Size::of_vertices(mesh.positions.len()).clusters);
            let size = Size { clusters, components: args.components, bits: args.bits };
            size.check()?;
            let of = precompute(&mesh, &table, &fibonacci(args.lights.into()), &options, &bars)?;
            encode(&mesh, &table, &of, eta, &size, &bars)?
        }
    };
    drop(bars);
    let bytes = args.meta.added_to(bytes)?;
    write_bytes(&args.output, &bytes)?;
    let file = Transfer::parse(&bytes).map_err(|error| read_error(&args.output, error))?;
    report::written(&args.output, &file, bytes.len(), began.elapsed());
    Ok(())
}

impl Args {
    /// What is looked for in a file for so many vertices.
    fn target(&self, vertices: usize) -> anyhow::Result<Option<Target>> {
        if let Some(bytes) = self.target_bytes_per_vertex.filter(|bytes| !bytes.is_finite() || *bytes <= 0.0) {
            return Err(bad_request(format!("{bytes} bytes per vertex; expected a number above 0, for example 20")));
        }
        #[allow(
            clippy::cast_precision_loss,
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "numbers out of range saturate"
        )]
        let bytes = |per_vertex: f64| (per_vertex * vertices as f64) as u64;
        let of_bytes = self.target_bytes_per_vertex.map(|per_vertex| Target::Bytes(bytes(per_vertex)));
        let target = self.target_error.map(|error| Target::Quality(-error)).or(of_bytes);
        target.map(|target| self.meta.leave_room(target)).transpose()
    }
}

/// The file to take; says what is tried.
fn searched(source: &TransferSource<'_>, target: Target, args: &Args, bars: &Bars) -> anyhow::Result<Vec<u8>> {
    let _graceful = Graceful::new();
    outln!("rate-distortion curve, e_rms of the worst view and of all, and that of q before it is compressed:");
    let curve = search(source, target, bars, &mut |point| report::tried(source.mesh.positions.len(), point))
        .map_err(|error| args.meta.explain(error, args.target_bytes_per_vertex.is_some()))?;
    if curve.stopped {
        let error = curve.chosen().distortion.total.max;
        outln!("  interrupted: the best file so far is written, of {error:.2e} in the worst view");
    }
    Ok(curve.chosen().file.clone())
}

/// The profile that is asked for, and the refractive index that comes with it.
fn profile(args: &Args) -> anyhow::Result<(Profile, f32)> {
    if let Some(path) = &args.profile {
        return Ok((Profile::read(path)?, 1.3));
    }
    let name = args.material.as_deref().unwrap_or_default();
    let profile = shipped::profile(name).ok_or_else(|| bad_request(format!("no material is called {name}")))?;
    #[allow(clippy::cast_possible_truncation, reason = "an index of few digits")]
    let eta = Medium::measured_eta(name) as f32;
    Ok((profile, eta))
}
