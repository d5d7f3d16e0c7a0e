//! What a transfer file is, in words.

use std::path::Path;
use std::time::Duration;

use subsurf_decoder::Transfer;
use subsurf_encoder::rate::transfer::{Point, TransferCandidate, TransferDistortion};
use subsurf_viewer::human;

use crate::outln;

/// The file that was written.
pub(super) fn written(path: &Path, file: &Transfer<'_>, bytes: usize, took: Duration) {
    let header = file.header();
    outln!(
        "{}: {} vertices, {} lights, {} channels, {}, {:.1} bytes per vertex, in {:.1} s",
        path.display(),
        header.vertices,
        header.lights,
        header.channels,
        human(bytes as u64),
        bytes_per_vertex(file, bytes),
        took.as_secs_f64()
    );
    outln!("  {}", clusters(file));
}

/// Line about one file that was tried.
pub(super) fn tried(vertices: usize, point: &Point) {
    let TransferCandidate { lights, size } = &point.candidate;
    let TransferDistortion { total, interpolation } = &point.distortion;
    #[allow(clippy::cast_precision_loss, reason = "a ratio for people")]
    let per_vertex = point.bytes() as f64 / vertices as f64;
    outln!(
        "  {:>8}, {per_vertex:>5.1} bytes per vertex: {lights:>4} lights, {:>3} clusters of {:>2} components, {:>3} bits: {:.2e} {:.2e}; {:.2e} {:.2e}",
        human(point.bytes() as u64),
        size.clusters,
        size.components,
        size.bits,
        total.max,
        total.rms,
        interpolation.max,
        interpolation.rms
    );
}

/// Clusters, components and records in a line.
pub(crate) fn clusters(file: &Transfer<'_>) -> String {
    let header = file.header();
    let bits: Vec<String> = header.bits.iter().take(header.components()).map(u8::to_string).collect();
    format!(
        "clusters: {}, of {} components along {} axes, in {} bits; {} bytes for each vertex",
        header.clusters,
        header.components(),
        header.axes,
        bits.join(" "),
        header.record_bytes()
    )
}

/// Bytes of a file over its vertices, side data included.
pub(crate) fn bytes_per_vertex(file: &Transfer<'_>, bytes: usize) -> f64 {
    #[allow(clippy::cast_precision_loss, reason = "a ratio for people")]
    let bytes = bytes as f64;
    bytes / f64::from(file.header().vertices)
}
