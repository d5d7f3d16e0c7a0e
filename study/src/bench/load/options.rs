//! What all measurements of loading have in common: options, and a process for each file.

use std::ffi::OsStr;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, bail};
use clap::ValueEnum;
use subsurf_cli::devices::{self, BackendArg};
use subsurf_cli::program::failure::bad_request;
use subsurf_runtime::Gpu;
use tempfile::TempDir;

use super::results::Storage;

/// Technique that a translucent material is loaded for and drawn by.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub(super) enum Way {
    /// Planes as they stand in the file, gathered on a flat patch.
    Gather,
    /// Splats on a mesh.
    Splat,
    /// Separable blurs on a mesh.
    Separable,
}

/// Options of all measurements of loading.
#[derive(clap::Args)]
pub(super) struct LoadOptions {
    /// Runs of each, warm and cold
    #[arg(long, default_value_t = 20)]
    pub(super) runs: usize,
    /// What draws
    #[arg(long, value_enum, default_value = "auto")]
    backend: BackendArg,
    /// Folder for the files, which are deleted at the end; the last case needs a gigabyte
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
    /// Leave the files of the last case in that folder, as for load_test on a phone
    #[arg(long, requires = "dir")]
    keep: bool,
    /// Report as JSON
    #[arg(long)]
    pub(super) json: bool,
}

impl LoadOptions {
    /// A folder for files, which goes with its value.
    pub(super) fn folder(&self) -> anyhow::Result<TempDir> {
        let folder = match &self.dir {
            Some(dir) => tempfile::tempdir_in(dir),
            None => tempfile::tempdir(),
        };
        folder.map_err(|error| bad_request(format!("no folder for the files, name one with --dir: {error}")))
    }

    /// Deletes a file, or leaves it in the folder that was named.
    pub(super) fn done_with(&self, file: &Path) -> std::io::Result<()> {
        match (self.keep, &self.dir, file.file_name()) {
            (true, Some(dir), Some(name)) => std::fs::rename(file, dir.join(name)),
            _ => std::fs::remove_file(file),
        }
    }

    /// What draws, if it is a device.
    pub(super) fn open(&self) -> anyhow::Result<Option<Gpu>> {
        self.backend.open()
    }

    /// Whether a device draws, not the CPU.
    pub(super) fn has_device(&self) -> anyhow::Result<bool> {
        Ok(self.open()?.is_some())
    }

    /// Name of what draws.
    pub(super) fn device(&self) -> anyhow::Result<String> {
        Ok(devices::name(self.backend.open()?.as_ref()))
    }
}

/// Loads one file in a process of its own, with what `more` says of it: how it is drawn, where the images of a BTF are.
pub(super) fn load_one(file: &Path, more: &[&OsStr], options: &LoadOptions) -> anyhow::Result<Storage> {
    let backend = options.backend.to_possible_value().context("backends have names")?;
    let mut command = Command::new(std::env::current_exe()?);
    command.args(["bench", "load-one", "--runs", &options.runs.to_string(), "--backend", backend.get_name()]).arg(file);
    command.args(more);
    let output = command.stderr(Stdio::piped()).output()?;
    if !output.status.success() {
        std::io::stderr().write_all(&output.stderr)?;
        bail!("{}: loading failed, see above", file.display());
    }
    serde_json::from_slice(&output.stdout).with_context(|| format!("{}: no result", file.display()))
}
