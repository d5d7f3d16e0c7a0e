//! What transfer files say of themselves.

use serde_json::json;
use subsurf_decoder::{File, Transfer};
use subsurf_viewer::human;

use super::{Args, print_json, print_rest};
use crate::outln;
use crate::transfer::{bytes_per_vertex, clusters};

pub(super) fn info(args: &Args, bytes: &[u8], file: &File<'_>, transfer: &Transfer<'_>) {
    let header = transfer.header();
    let per_vertex = bytes_per_vertex(transfer, bytes.len());
    let reflectance: Vec<f32> = transfer.tail().iter().take(3).collect();
    if args.json {
        let value = json!({
            "model": "transfer", "channels": header.channels, "lights": header.lights, "clusters": header.clusters,
            "axes": header.axes,
            "components": header.components(), "bits": header.bits[..header.components()], "vertices": header.vertices,
            "positions_crc": header.positions_crc, "triangles_crc": header.triangles_crc, "radius_mm": header.radius_mm,
            "eta": header.eta, "reflectance": reflectance, "bytes": bytes.len(), "bytes_per_vertex": per_vertex,
        });
        return print_json(value, file.container());
    }
    outln!(
        "{}: transfer of {} vertices, {}, {per_vertex:.1} bytes per vertex",
        args.file.display(),
        header.vertices,
        human(bytes.len() as u64)
    );
    outln!("  lights: {}, channels: {}, linear Rec. 709", header.lights, header.channels);
    outln!("  {}", clusters(transfer));
    outln!("  for the mesh of CRC-32 {:08x}, {:08x}", header.positions_crc, header.triangles_crc);
    outln!("  radius {:.3} mm, reflectance {reflectance:.3?}, refractive index {}", header.radius_mm, header.eta);
    print_rest(file.container());
}
