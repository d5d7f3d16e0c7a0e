//! The separable basis of a file: for the file that is encoded, or for one that is there.

use std::path::{Path, PathBuf};

use serde_json::{Value, json};
use subsurf_decoder::Bssrdf;
use subsurf_encoder::Progress;
use subsurf_encoder::bssrdf::Encoded;
use subsurf_encoder::bssrdf::basis::{BasisChoice, BasisOptions, add_basis, basis_bytes};
use subsurf_encoder::capture::Capture;
use subsurf_encoder::rate::Target;
use subsurf_encoder::{check_target, write_bytes};
use subsurf_viewer::{human, read};

use crate::info::{basis_line, basis_to_json, parse};
use crate::metadata::MetaArgs;
use crate::outln;
use crate::program::failure::bad_request;
use crate::program::interrupt::Graceful;
use crate::program::progress::Bars;

/// Arguments about the separable basis.
#[derive(clap::Args)]
pub(super) struct BasisArgs {
    /// How close separable blurs are to come to the gather of the file, PSNR in dB under uniform, disc and line light: the file
    /// gets the cheapest basis that does, of at most two maps and four blurs, or the closest
    #[arg(long, value_name = "DB", default_value_t = 45.0)]
    basis_psnr: f64,
    /// Leave the separable basis out: some 600 bytes less, and the file is drawn by splat and gather only
    #[arg(long, conflicts_with = "basis_psnr")]
    no_basis: bool,
    /// Give this .subsurf file a separable basis, in place of one that it may have; everything else in it stays as it is
    #[arg(long, value_name = "FILE", conflicts_with_all = OF_CAPTURES)]
    pub(super) add_basis: Option<PathBuf>,
}

/// Arguments that say nothing to a file that is there.
const OF_CAPTURES: [&str; 12] = [
    "capture",
    "method",
    "per_pixel",
    "base_materials",
    "coding",
    "half_profiles",
    "target_psnr",
    "target_bytes",
    "samples",
    "seed",
    "max_memory",
    "no_basis",
];

impl BasisArgs {
    fn options(&self) -> anyhow::Result<BasisOptions> {
        if !self.basis_psnr.is_finite() {
            return Err(bad_request(format!("--basis-psnr is {}; it must be a number of dB", self.basis_psnr)));
        }
        Ok(BasisOptions { choice: BasisChoice::Psnr(self.basis_psnr), ..BasisOptions::default() })
    }

    /// What a target in bytes leaves beside the basis, and the bytes that are kept for that.
    pub(super) fn leave_room(
        &self,
        target: Target,
        capture: &Capture,
        samples: Option<usize>,
    ) -> anyhow::Result<(Target, u64)> {
        let Target::Bytes(limit) = target else { return Ok((target, 0)) };
        let kept = if self.no_basis { 0 } else { basis_bytes(capture, samples)? };
        let rest = limit.checked_sub(kept).filter(|rest| *rest > 0);
        rest.map(|rest| (Target::Bytes(rest), kept)).ok_or_else(|| {
            bad_request(format!("{limit} bytes: a separable basis alone takes up to {kept}; --no-basis leaves it out"))
        })
    }

    /// The same file with its basis, unless there is to be none.
    pub(super) fn added_to(&self, encoded: Encoded, progress: &dyn Progress) -> anyhow::Result<Encoded> {
        if self.no_basis {
            return Ok(encoded);
        }
        let bytes = add_basis(&encoded.bytes, &self.options()?, progress)?;
        Ok(Encoded { bytes, ..encoded })
    }
}

/// Adds a basis to a file.
pub(super) fn add(path: &Path, output: &Path, args: &BasisArgs, meta: &MetaArgs, json: bool) -> anyhow::Result<()> {
    let options = args.options()?;
    check_target(output)?;
    let before = read(path)?;
    parse(path, &before)?;
    let graceful = Graceful::new();
    let bytes = meta.added_to(add_basis(&before, &options, &Bars::new())?)?;
    write_bytes(output, &bytes)?;
    drop(graceful);
    let material = Bssrdf::parse(&bytes)?;
    if json {
        let basis = material.basis().map_or(Value::Null, basis_to_json);
        outln!("{:#}", json!({ "file": output, "bytes": bytes.len(), "basis": basis }));
        return Ok(());
    }
    outln!("{}: {}, {} before", output.display(), human(bytes.len() as u64), human(before.len() as u64));
    if let Some(basis) = material.basis() {
        outln!("  {}", basis_line(basis));
    }
    Ok(())
}
