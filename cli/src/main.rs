//! The `subsurf` command.

mod bench;
mod compare;
mod curve;
mod demo;
mod devices;
mod encode;
mod failure;
mod info;
mod interrupt;
mod memory;
mod options;
mod picture;
mod progress;
mod render;
mod say;
mod simulate;
mod study;
mod view;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Measured translucent and textured materials, small enough for a phone.
///
/// A capture (NAME.npy) or a simulation becomes a .subsurf file of 48 bits per pixel, and the images of a rough surface (a
/// BTF) one of some 100 kB, which a no_std decoder reads and a GLES 3.0 device draws.
#[derive(Parser)]
#[command(name = "subsurf", version, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Try it:
  subsurf demo                                            all of it once, into ./demo-out
  subsurf simulate --scene onyx -o onyx.npy               a capture where nothing was measured
  subsurf encode onyx.npy -o onyx.subsurf                 fit 128 base materials, two per pixel
  subsurf compare onyx.npy onyx.subsurf --images out      how far off, in numbers and pictures
  subsurf render onyx.subsurf --mesh bunny.ply -o b.png   draw it
  subsurf view onyx.subsurf --mesh bunny.ply              look at it from all around

  subsurf simulate btf leather -o leather                 6,561 images of a rough surface, from all sides
  subsurf encode btf leather -o leather.subsurf           the same in some 110 kB
  subsurf render leather.subsurf --images leather -o l.png  both on a knot, beside each other

Exit codes:
  0   done
  1   this machine failed: disk full, driver crashed
  2   the input or the request is wrong
  3   there is no device that can do it
  130 interrupted or terminated; encode still writes the best fit so far";

#[derive(Subcommand)]
enum Command {
    Simulate(simulate::Args),
    Encode(encode::Args),
    Compare(compare::Args),
    Render(render::Args),
    View(view::Args),
    Info(info::Args),
    /// List the devices that can draw, Vulkan and OpenGL ES; exit with 3 if there is none
    Devices,
    #[command(subcommand)]
    Bench(bench::Command),
    Study(study::Args),
    Demo(demo::Args),
}

fn main() -> ExitCode {
    devices::settle_drivers();
    interrupt::watch();
    let result = match Cli::parse().command {
        Command::Simulate(args) => simulate::run(&args),
        Command::Encode(args) => encode::run(&args),
        Command::Compare(args) => compare::run(&args),
        Command::Render(args) => render::run(&args),
        Command::View(args) => view::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Devices => devices::run(),
        Command::Bench(command) => bench::run(&command),
        Command::Study(args) => study::run(&args),
        Command::Demo(args) => demo::run(&args),
    };
    match result {
        Ok(()) if interrupt::came() => ExitCode::from(interrupt::INTERRUPTED),
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => failure::report(&error),
    }
}
