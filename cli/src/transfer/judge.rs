//! `subsurf compare` of transfer files: how far a file is from the exact sums on its mesh.

use std::path::Path;

use serde_json::{Value, json};
use subsurf_decoder::Transfer;
use subsurf_encoder::metrics::transfer::{ImageError, judge};
use subsurf_viewer::read;

use super::report::bytes_per_vertex;
use crate::options::MeshArgs;
use crate::outln;
use crate::program::failure::read_error;
use crate::program::progress::Bars;

/// Judges a file against its mesh.
pub(crate) fn compare(mesh: &Path, size: &MeshArgs, path: &Path, as_json: bool) -> anyhow::Result<()> {
    let bytes = read(path)?;
    let file = Transfer::parse(&bytes).map_err(|error| read_error(path, error))?;
    let error = judge(&size.load(mesh)?, &file, &Bars::new())?;
    let per_vertex = bytes_per_vertex(&file, bytes.len());
    let parts = [
        ("compression", error.compression),
        ("a byte for each light (Lloyd)", error.lloyd),
        ("file against exact sums", error.total),
        ("the same by the four nearest lights", error.four_nearest),
    ];
    if as_json {
        let of = |ImageError { max, rms }: ImageError| json!({ "max": max, "rms": rms });
        let value: Value = json!({
            "bytes": bytes.len(), "bytes_per_vertex": per_vertex, "rms_q": error.q, "compression": of(error.compression), "lloyd": of(error.lloyd),
            "total": of(error.total), "four_nearest": of(error.four_nearest),
        });
        outln!("{value:#}");
        return Ok(());
    }
    outln!("{} against {}: {per_vertex:.1} bytes per vertex", path.display(), mesh.display());
    outln!("  rms of q {:.2e}, of its largest value", error.q);
    outln!("  in images between the lights:        e_rms of the worst view, of all views");
    for (name, ImageError { max, rms }) in parts {
        outln!("  {name:<36} {max:.2e}   {rms:.2e}");
    }
    Ok(())
}
