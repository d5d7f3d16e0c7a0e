//! `subsurf simulate`: captures and BTFs where nothing was measured.

pub mod btf;
mod capture;
mod maps;
mod mcml;
mod profile;

use crate::program::failure::bad_request;
pub use capture::MaterialArg;

/// Simulate a capture: light in a slab of given media, measured pixel by pixel.
///
/// Solves −∇·(D∇φ) + σ_a φ = Q below every pixel in turn, lit by a beam as wide as the pixel, or traces photons, and
/// writes what leaves the surface within the window: NAME.npy, floats of shape (height, width, D, D, 3) in mm⁻², and NAME.json beside it.
#[derive(clap::Args)]
#[command(after_help = maps::HELP, args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    other: Option<Other>,
    #[command(flatten)]
    capture: Option<capture::SlabArgs>,
}

/// Simulations that are no captures.
#[derive(clap::Subcommand)]
enum Other {
    Btf(btf::Args),
    Profile(profile::Args),
    Mcml(mcml::Args),
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    match (&args.other, &args.capture) {
        (Some(Other::Btf(args)), _) => btf::run(args),
        (Some(Other::Profile(args)), _) => profile::run(args),
        (Some(Other::Mcml(args)), _) => mcml::run(args),
        (None, Some(args)) => capture::run(args),
        (None, None) => {
            Err(bad_request("what is to be simulated? Give --material or --maps, or `btf`, `profile` or `mcml`"))
        }
    }
}
