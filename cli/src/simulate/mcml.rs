//! `subsurf simulate mcml`: runs of MCML's input files.

use std::path::{Path, PathBuf};
use std::time::Instant;

use subsurf_encoder::simulate::monte_carlo::{Estimate, mcml};
use subsurf_encoder::{Error, check_target, write_bytes};

use crate::outln;
use crate::program::failure::bad_request;
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;
use crate::program::threads;

/// Run an input file of MCML, version 1 or 2: every run in it, each to its own .mco file.
///
/// The physics and the files are those of MCML (Wang, Jacques and Zheng 1995); random numbers are others, so results agree
/// within their standard errors. Files are text even where binary is asked for.
#[derive(clap::Args)]
pub(super) struct Args {
    /// The .mci file
    input: PathBuf,
    /// The folder for the .mco files
    #[arg(long, short, value_name = "DIR", default_value = ".")]
    output: PathBuf,
    /// Photon packets of every run, instead of what the file says
    #[arg(long)]
    photons: Option<u64>,
    /// Threads to use, at most eight for each core; the files are the same for any number
    #[arg(long)]
    threads: Option<usize>,
}

pub(super) fn run(args: &Args) -> anyhow::Result<()> {
    threads::set(args.threads)?;
    let mut runs = mcml::read(&args.input)?;
    let mut targets = Vec::new();
    for run in &mut runs {
        // Names come from a file that anybody wrote: they stay in the folder that was asked for.
        if Path::new(&run.output).file_name() != Some(run.output.as_ref()) {
            return Err(bad_request(format!(
                "{}: output file {:?} is not a plain file name; change it there",
                args.input.display(),
                run.output
            )));
        }
        let target = args.output.join(&run.output);
        let is_input =
            std::fs::canonicalize(&target).is_ok_and(|target| Some(target) == std::fs::canonicalize(&args.input).ok());
        if is_input || targets.contains(&target) {
            return Err(bad_request(format!(
                "{}: output file {:?} is that of another run, or the input; change it there, or take another --output",
                args.input.display(),
                run.output
            )));
        }
        targets.push(target);
        run.request.packets = args.photons.unwrap_or(run.request.packets);
    }
    std::fs::create_dir_all(&args.output).map_err(|source| Error::Output { path: args.output.clone(), source })?;
    targets.iter().try_for_each(|target| check_target(target))?;
    for (run, path) in runs.iter().zip(&targets) {
        let start = Instant::now();
        let outcome = {
            let _graceful = Graceful::new();
            run.request.run(&Bars::new())?
        };
        write_bytes(path, mcml::write(run, &outcome).as_bytes())?;
        outln!("{}: {} photon packets in {:.1} s", path.display(), outcome.packets, start.elapsed().as_secs_f64());
        let parts = [
            ("reflected", outcome.reflected),
            ("absorbed", outcome.absorbed),
            ("transmitted", outcome.transmitted),
            ("reflected, unscattered", outcome.ballistic_reflected),
            ("transmitted, unscattered", outcome.ballistic_transmitted),
        ];
        outln!("  mirrored {:.6}", outcome.specular);
        for (name, Estimate { mean, standard_error }) in parts {
            if mean > 0.0 {
                outln!("  {name} {mean:.6} ± {standard_error:.6}");
            }
        }
        if outcome.packets < run.request.packets {
            break;
        }
    }
    Ok(())
}
