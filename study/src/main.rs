//! The papers' experiments on simulated materials, and all benchmarks.

mod bench;
mod bssrdf;
mod btf;
mod cache;
mod kernels;
mod linsss;
mod meshes;
mod page;
mod photons;

use std::process::ExitCode;

use clap::{Parser, Subcommand};

/// Repeat the papers' experiments on simulated materials, and measure this machine.
///
/// Files to measure come from the command `subsurf`, which simulates and encodes.
#[derive(Parser)]
#[command(name = "subsurf-study", version, after_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  subsurf-study bssrdf out                                  Yatagawa et al. 2020, as one page: an hour
  subsurf-study bssrdf out --materials jade --no-paper      one material, without the paper's own method: a minute
  subsurf-study linsss out                                  a rival's model, fitted to the captures of the first: ten minutes
  subsurf-study photons out                                 diffusion beside photons, as one page: half an hour
  subsurf-study btf out                                     Havran et al. 2010, as one page: more than an hour
  subsurf-study kernels out                                 Jimenez et al. 2015: separable kernels, as one page
  subsurf-study meshes -o out                               Hao and Varshney 2004 on meshes, as one page: ten minutes
  subsurf-study bench load                                  load size and latency, compressed and not
  subsurf-study bench render jade.subsurf -o out            every path against the reference, as one page
  subsurf-study bench btf leather.subsurf --images leather  frames of a BTF, compressed and not

Exit codes: 0 done, 1 this machine failed, 2 the input or the request is wrong, 3 there is no device that can do it,
130 interrupted.";

#[derive(Subcommand)]
enum Command {
    Bssrdf(bssrdf::Args),
    Btf(btf::Args),
    Kernels(kernels::Args),
    Linsss(linsss::Args),
    Meshes(meshes::Args),
    Photons(photons::Args),
    #[command(subcommand)]
    Bench(bench::Command),
}

fn main() -> ExitCode {
    subsurf_cli::program::run("subsurf-study", |cli: Cli| match cli.command {
        Command::Bssrdf(args) => bssrdf::run(&args),
        Command::Btf(args) => btf::run(&args),
        Command::Kernels(args) => kernels::run(&args),
        Command::Linsss(args) => linsss::run(&args),
        Command::Meshes(args) => meshes::run(&args),
        Command::Photons(args) => photons::run(&args),
        Command::Bench(command) => bench::run(&command),
    })
}
