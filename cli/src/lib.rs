//! The `subsurf` command, and what programs beside it share: arguments, reports, progress, exit codes.
//!
//! `subsurf-study` uses the modules that are public here; applications use `subsurf-decoder`, `subsurf-encoder`,
//! `subsurf-runtime` and `subsurf-viewer` instead.

pub mod compare;
mod demo;
pub mod devices;
mod encode;
pub mod images;
pub mod info;
mod kernel;
mod metadata;
pub mod options;
pub mod picture;
pub mod program;
mod render;
pub mod simulate;
mod transfer;
mod view;

use clap::{Parser, Subcommand};

/// Measured translucent and textured materials, small enough for a phone.
///
/// A capture (NAME.npy) or a simulation becomes a .subsurf file of 48 bits per pixel, and the images of a rough surface (a
/// BTF) one of some 100 kB, which a no_std decoder reads and a GLES 3.0 device draws.
#[derive(Parser)]
#[command(name = "subsurf", version, after_help = EXAMPLES)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Try it:
  subsurf demo                                            all of it once, into ./demo-out
  subsurf simulate --material onyx -o onyx.npy            a capture where nothing was measured
  subsurf encode onyx.npy -o onyx.subsurf                 fit 128 base materials, two per pixel
  subsurf compare onyx.npy onyx.subsurf --images out      how far off, in numbers and pictures
  subsurf render onyx.subsurf --mesh bunny.ply -o b.png   draw it
  subsurf view onyx.subsurf --mesh bunny.ply              look at it from all around

  subsurf simulate btf leather -o leather                 6,561 images of a rough surface, from all sides
  subsurf encode btf leather -o leather.subsurf           the same in some 110 kB
  subsurf render leather.subsurf --images leather -o l.png  both on a knot, beside each other

  subsurf kernel --material skin1 -o skin.subsurf         homogeneous skin, as two convolutions on the screen
  subsurf transfer bunny.ply --material marble -o m.subsurf  marble on one mesh, some bytes per vertex

Exit codes:
  0   done
  1   this machine failed: disk full, driver crashed
  2   the input or the request is wrong
  3   there is no device that can do it
  130 interrupted or terminated; after one Ctrl-C encode still writes the best fit so far, simulate profile what it traced";

#[derive(Subcommand)]
enum Command {
    Simulate(simulate::Args),
    Encode(encode::Args),
    Kernel(kernel::Args),
    Transfer(transfer::Args),
    Compare(compare::Args),
    Render(render::Args),
    View(view::Args),
    Info(info::Args),
    /// List the devices that can draw, Vulkan and OpenGL ES; exit with 3 if there is none
    Devices,
    Demo(demo::Args),
}

/// Runs the subcommand that the arguments ask for.
///
/// # Errors
///
/// Those of the subcommand; [`program::run`] makes a line and an exit code of them.
pub fn run(cli: Cli) -> anyhow::Result<()> {
    match cli.command {
        Command::Simulate(args) => simulate::run(&args),
        Command::Encode(args) => encode::run(&args),
        Command::Kernel(args) => kernel::run(&args),
        Command::Transfer(args) => transfer::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Render(args) => render::run(&args),
        Command::View(args) => view::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Devices => devices::run(),
        Command::Demo(args) => demo::run(&args),
    }
}

#[cfg(test)]
mod tests {
    use clap::CommandFactory;

    #[test]
    fn arguments_are_consistent() {
        super::Cli::command().debug_assert();
    }
}
