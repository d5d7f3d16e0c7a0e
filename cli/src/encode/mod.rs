//! `subsurf encode`: from what was measured to a file.

mod basis;
mod btf;
mod capture;
mod curve;
mod report;

/// Fit a material to a capture and write a .subsurf file; `encode btf` does so with the images of a BTF.
///
/// Ctrl-C ends the fit early and writes the best model so far; once more ends the program, and so does SIGTERM.
#[derive(clap::Args)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
pub(crate) struct Args {
    #[command(subcommand)]
    other: Option<Other>,
    #[command(flatten)]
    capture: capture::FitArgs,
}

/// Inputs that are no captures.
#[derive(clap::Subcommand)]
enum Other {
    Btf(btf::Args),
}

pub(crate) fn run(args: &Args) -> anyhow::Result<()> {
    match &args.other {
        Some(Other::Btf(args)) => btf::run(args),
        None => capture::run(&args.capture),
    }
}
