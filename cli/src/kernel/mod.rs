//! `subsurf kernel`: a diffusion profile as convolutions along two axes.

mod input;
mod report;

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use subsurf_encoder::kernel::{KernelMethod, MAX_TERMS, Options, TwoGaussians, compare, encode};
use subsurf_encoder::simulate::diffusion::medium::MEASURED;
use subsurf_encoder::{check_target, write_bytes};

use crate::metadata::MetaArgs;
use crate::program::failure::bad_request;
use crate::program::threads;

/// Make a separable kernel of a homogeneous material: what light does below its surface, as two 1-D convolutions on the screen.
///
/// Takes a diffuse reflectance profile R_d(r), which has one value for every distance, and writes NAME.subsurf with products
/// a(x) a(y) in a few taps, as games draw skin (Jimenez et al. 2015, Separable subsurface scattering). Reports how far these are
/// from the exact convolution in the plane.
#[derive(clap::Args)]
#[command(after_help = HELP)]
pub(crate) struct Args {
    /// A profile: a .csv of r and R_d, an .mco file of MCML (or three, of red, green and blue), or a .subsurf file for --base
    #[arg(num_args = 1..=3, required_unless_present_any = ["material", "near"], conflicts_with_all = ["material", "near"])]
    input: Vec<PathBuf>,
    /// A measured material (Jensen et al. 2001), half-infinite
    #[arg(long, value_parser = PossibleValuesParser::new(MEASURED.map(|(name, _)| name)), conflicts_with = "near")]
    material: Option<String>,
    /// Where the profile of --material comes from [default: monte-carlo]
    #[arg(long, value_enum)]
    model: Option<input::Model>,
    /// Number of the base material of a .subsurf file, from 0
    #[arg(long, value_name = "N", requires = "input")]
    base: Option<u16>,
    /// Trace that many photon packets per channel of --material, instead of taking the profile that comes with the command
    #[arg(long)]
    photons: Option<u64>,
    /// The .subsurf file to write
    #[arg(long, short, required_unless_present = "compare")]
    output: Option<PathBuf>,
    #[command(flatten)]
    meta: MetaArgs,
    /// How the profile becomes separable; see below [default: pre-integrated, or two-gaussians with --near]
    #[arg(long, value_parser = PossibleValuesParser::new(KernelMethod::ALL.map(KernelMethod::name)))]
    method: Option<String>,
    /// Products a(x) a(y) of svd and gaussians, 1 to 6; each takes two convolutions
    #[arg(long, value_name = "N")]
    terms: Option<usize>,
    /// Samples of a convolution, an odd number from 5 to 65
    #[arg(long, value_name = "N", default_value_t = Options::default().taps)]
    taps: usize,
    /// k of guided: 0 for near scattering to 4 for far scattering [default: 1.55, neutral]
    #[arg(long, value_name = "K")]
    guide: Option<f64>,
    /// Variance of the near Gaussian along an axis in mm²: one number, or red/green/blue
    #[arg(long, value_name = "R/G/B")]
    near: Option<String>,
    /// Variance of the far Gaussian in mm²
    #[arg(long, value_name = "R/G/B")]
    far: Option<String>,
    /// Share of the near Gaussian, 0 to 1
    #[arg(long, value_name = "R/G/B")]
    weight: Option<String>,
    /// Share of all light that comes back; the profile is scaled to it [default: that of the profile; 1 with --near]
    #[arg(long, value_name = "R/G/B")]
    reflectance: Option<String>,
    /// Refractive index against air, 1 to 4; a material with another than its own is traced anew [default: that of the material or
    /// the file, else 1.3]
    #[arg(long)]
    eta: Option<f32>,
    /// Print the errors of all methods
    #[arg(long)]
    compare: bool,
    /// Threads to use, at most eight for each core; the file is the same for any number
    #[arg(long)]
    threads: Option<usize>,
}

const HELP: &str = "\
Methods:
  pre-integrated  the profile added up along an axis: exact where light changes along x or along y alone, as at shadow edges
  guided          the best single product under a guide, which favours near or far scattering (--guide)
  two-gaussians   an artist's model, by hand (--near, --far, --weight) or fitted
  svd             the closest of a given number of products (--terms, default 4)
  gaussians       a sum of Gaussians (d'Eon et al. 2007; --terms, default 4)

Tables have rows of r in mm and R_d in mm⁻² of red, green and blue, or of all, per light that entered the surface; a title and lines
of # are passed over.

Errors: Frobenius and L1 are those of the profile in the plane, as shares of it. Dot and edge are the largest errors of what is
seen around a lit disc and beside a shadow's edge, as shares of the brightest. Channels are averaged.

  subsurf kernel --material skin1 -o skin1.subsurf
  subsurf kernel --material skin1 --method svd --terms 4 --taps 33 -o skin1.subsurf
  subsurf kernel measured.csv --method guided --guide 3 -o far.subsurf
  subsurf kernel jade.subsurf --base 17 -o jade17.subsurf
  subsurf kernel --near 0.05/0.03/0.02 --far 1.2/0.4/0.2 --weight 0.4/0.6/0.7 -o artist.subsurf
  subsurf kernel --material marble --compare";

/// Terms of svd and gaussians where none are asked for.
const TERMS: usize = 4;

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    threads::set(args.threads)?;
    if let Some(output) = &args.output {
        check_target(output)?;
        if args.input.iter().any(|input| is_same(input, output)) {
            return Err(bad_request(format!("{}: is the input; name another file with -o", output.display())));
        }
    }
    let options = options(args)?;
    options.check()?;
    let (profile, eta) = input::profile(args, options.two_gaussians.as_ref())?;
    let options = Options { eta: args.eta.unwrap_or(eta), ..options };
    if let Some(output) = &args.output {
        let encoded = encode(&profile, &options)?;
        let bytes = args.meta.added_to(encoded.kernel.to_bytes()?)?;
        write_bytes(output, &bytes)?;
        report::kernel(output, &encoded, bytes.len());
    }
    if args.compare {
        let all = all_methods(&options);
        report::comparison(&all, &compare(&profile, &all)?);
    }
    Ok(())
}

/// What is asked for, but for the refractive index.
fn options(args: &Args) -> anyhow::Result<Options> {
    let by_hand = args.near.is_some();
    let named = args.method.as_deref();
    let method = KernelMethod::ALL.into_iter().find(|method| named == Some(method.name()));
    let method = method.unwrap_or(if by_hand { KernelMethod::TwoGaussians } else { KernelMethod::PreIntegrated });
    if args.guide.is_some() && method != KernelMethod::Guided && !args.compare {
        return Err(bad_request(format!("--guide is for --method guided, and this is {}", method.name())));
    }
    if by_hand && method != KernelMethod::TwoGaussians {
        return Err(bad_request(format!("--near is for --method two-gaussians, and this is {}", method.name())));
    }
    // The parser takes what an option requires for given where it conflicts with something that is.
    if args.material.is_none() && (args.model.is_some() || args.photons.is_some()) {
        return Err(bad_request("--model and --photons are for --material"));
    }
    if args.photons.is_some() && args.model == Some(input::Model::Dipole) {
        return Err(bad_request("--photons: the dipole is a formula, and nothing is traced"));
    }
    let two_gaussians = match (&args.near, &args.far, &args.weight) {
        (Some(near), Some(far), Some(weight)) => Some(TwoGaussians {
            weight: channels("--weight", weight)?,
            tau_near: channels("--near", near)?,
            tau_far: channels("--far", far)?,
        }),
        (None, None, None) => None,
        _ => return Err(bad_request("two Gaussians by hand need all of --near, --far and --weight, and no profile")),
    };
    let is_sum = matches!(method, KernelMethod::Svd | KernelMethod::Gaussians);
    Ok(Options {
        method,
        terms: args.terms.unwrap_or(if is_sum { TERMS } else { 1 }),
        taps: args.taps,
        guide: args.guide.unwrap_or(Options::default().guide),
        two_gaussians,
        eta: args.eta.unwrap_or(Options::default().eta),
    })
}

/// All methods, sums of every number of terms.
fn all_methods(options: &Options) -> Vec<Options> {
    let mut all = Vec::new();
    for method in KernelMethod::ALL {
        let is_sum = matches!(method, KernelMethod::Svd | KernelMethod::Gaussians);
        let most = if is_sum { usize::from(MAX_TERMS) } else { 1 };
        all.extend((1..=most).map(|terms| Options { method, terms, ..*options }));
    }
    all
}

/// One number for all channels, or three with `/` between them.
fn channels(name: &str, text: &str) -> anyhow::Result<[f32; 3]> {
    let numbers: Option<Vec<f32>> = text.split('/').map(|number| number.trim().parse().ok()).collect();
    match numbers.as_deref() {
        Some([all]) => Ok([*all; 3]),
        Some([r, g, b]) => Ok([*r, *g, *b]),
        _ => Err(bad_request(format!("{name} is {text}; expected one number, or red/green/blue"))),
    }
}

/// Whether both names are of one file that is there.
fn is_same(a: &std::path::Path, b: &std::path::Path) -> bool {
    std::fs::canonicalize(a).is_ok_and(|a| std::fs::canonicalize(b).is_ok_and(|b| a == b))
}
