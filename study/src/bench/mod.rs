//! `subsurf bench`: how long things take on this machine.

mod btf;
mod course;
mod frames;
mod load;
mod load_btf;
mod load_one;
mod patch;
mod render;
mod timing;

pub(crate) use load::{Case, markdown, measure};

/// Measure this machine.
#[derive(clap::Subcommand)]
pub(crate) enum Command {
    Load(load::Args),
    Frames(frames::Args),
    Patch(patch::Args),
    Btf(btf::Args),
    Render(render::Args),
    #[command(hide = true)]
    LoadOne(load_one::Args),
}

pub(crate) fn run(command: &Command) -> anyhow::Result<()> {
    match command {
        Command::Load(args) => load::run(args),
        Command::Frames(args) => frames::run(args),
        Command::Patch(args) => patch::run(args),
        Command::Btf(args) => btf::run(args),
        Command::Render(args) => render::run(args),
        Command::LoadOne(args) => load_one::run(args),
    }
}
