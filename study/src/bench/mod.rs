//! `subsurf-study bench`: how long things take on this machine.

mod basis;
mod blur;
mod btf;
mod case;
mod devices;
mod frames;
mod load;
mod meshes;
mod patch;
pub(crate) mod render;
mod timing;
mod traffic;

/// Measure this machine.
#[derive(clap::Subcommand)]
pub(crate) enum Command {
    Load(load::Args),
    Frames(frames::Args),
    Traffic(traffic::Args),
    Patch(patch::Args),
    Basis(basis::Args),
    Blur(blur::Args),
    Btf(btf::Args),
    Render(render::Args),
    #[command(hide = true)]
    LoadOne(load::OneArgs),
}

pub(crate) fn run(command: &Command) -> anyhow::Result<()> {
    match command {
        Command::Load(args) => load::run(args),
        Command::Frames(args) => frames::run(args),
        Command::Traffic(args) => traffic::run(args),
        Command::Patch(args) => patch::run(args),
        Command::Basis(args) => basis::run(args),
        Command::Blur(args) => blur::run(args),
        Command::Btf(args) => btf::run(args),
        Command::Render(args) => render::run(args),
        Command::LoadOne(args) => load::run_one(args),
    }
}
