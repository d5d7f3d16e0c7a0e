//! Transfer to `.subsurf` files, through the decoder's own layout.

use subsurf_decoder::Section;
use subsurf_decoder::transfer::TransferHeader;
use subsurf_decoder::transfer::layout::MAX_COMPONENTS;
use subsurf_scene::Mesh;

use super::compress::{Quantised, Size, compress};
use super::precompute::Precomputed;
use super::rd_table::RdTable;
use crate::error::{Error, Result};
use crate::file::container;
use crate::file::reread::reread;
use crate::memory;
use crate::progress::Progress;

/// Copies of q that compression holds at once, besides the one it is given.
const COPIES: u64 = 2;

/// File of what was precomputed for a mesh of a material, compressed to a size. Read again by the decoder.
///
/// # Errors
/// [`Error::Request`] for sizes, numbers of lights or of vertices that files do not have.
pub fn encode(
    mesh: &Mesh,
    table: &RdTable,
    of: &Precomputed,
    eta: f32,
    size: &Size,
    progress: &dyn Progress,
) -> Result<Vec<u8>> {
    size.check()?;
    let (lights, vertices) = (of.light_count(), of.place_of.len());
    let usual = header(vertices, table, of.channels, lights, size)?;
    memory::expect(COPIES * 4 * of.q.len() as u64, || format!("compressing {lights} lights at {vertices} vertices"))?;
    let quantised = compress(of, size, progress);
    let [positions_crc, triangles_crc] = mesh.geometry_crc();
    let header = TransferHeader {
        positions_crc,
        triangles_crc,
        eta,
        scale: [0, 1, 2].map(|c| quantised.scales.get(c).copied().unwrap_or(1.0)),
        bits: quantised.bits,
        ..usual
    };
    let floats = |values: &[f32]| values.iter().flat_map(|value| value.to_le_bytes()).collect::<Vec<u8>>();
    let means: Vec<u8> = quantised.means.iter().flat_map(|value| value.to_le_bytes()).collect();
    let bytes = |values: &[i8]| values.iter().map(|value| value.cast_unsigned()).collect::<Vec<u8>>();
    let [axes, components] = [&quantised.axes, &quantised.components].map(|values| bytes(values));
    let (head, codes) = (header.to_bytes(), codes(&quantised, &header, &of.place_of));
    let [ranges, lights, tail] =
        [quantised.ranges.as_flattened(), of.lights.as_flattened(), table.tail.as_flattened()].map(floats);
    let contents = [&head[..], &lights, &axes, &ranges, &means, &components, &codes, &tail];
    reread(container::write(SECTIONS.into_iter().zip(contents)))
}

/// Bytes of a file that [`encode`] makes of a mesh of so many vertices.
///
/// # Errors
/// As [`encode`].
pub fn file_bytes(vertices: usize, table: &RdTable, channels: usize, lights: usize, size: &Size) -> Result<u64> {
    size.check()?;
    let header = header(vertices, table, channels, lights, size)?;
    Ok(container::file_bytes(&SECTIONS.map(|section| header.section_bytes(section))))
}

/// Sections of a file, in their order.
const SECTIONS: [Section; 8] = [
    Section::TransferHeader,
    Section::Lights,
    Section::LightAxes,
    Section::ClusterRanges,
    Section::ClusterMeans,
    Section::ClusterBases,
    Section::VertexCodes,
    Section::KernelTail,
];

/// Header of a file before anything is compressed: for no mesh, of η and scale 1, its bits shared evenly.
fn header(vertices: usize, table: &RdTable, channels: usize, lights: usize, size: &Size) -> Result<TransferHeader> {
    let refuse = |what: String| Error::Request(format!("{what} are more than a file has"));
    let Size { clusters, components, bits } = *size;
    let share = |k: usize| if k < components { bits / components + usize::from(k < bits % components) } else { 0 };
    Ok(TransferHeader {
        channels: if channels == 1 { 1 } else { 3 },
        lights: u16::try_from(lights).map_err(|_| refuse(format!("{lights} lights")))?,
        clusters: u16::try_from(clusters).unwrap_or(u16::MAX),
        tail_nodes: u16::try_from(table.tail.len()).map_err(|_| refuse(format!("{} nodes", table.tail.len())))?,
        vertices: u32::try_from(vertices).map_err(|_| refuse(format!("{vertices} vertices")))?,
        positions_crc: 0,
        triangles_crc: 0,
        radius_mm: table.radius_mm,
        eta: 1.0,
        scale: [1.0; 3],
        bits: std::array::from_fn(|k| u8::try_from(share(k)).unwrap_or(u8::MAX)),
        axes: u16::try_from(size.axes(channels, lights)).unwrap_or(u16::MAX),
    })
}

/// Records of the vertices, in the mesh's order.
fn codes(quantised: &Quantised, header: &TransferHeader, place_of: &[u32]) -> Vec<u8> {
    let record_bytes = header.record_bytes();
    let mut out = Vec::with_capacity(place_of.len() * record_bytes);
    for place in place_of {
        let (cluster, codes): (u8, [u16; MAX_COMPONENTS]) = quantised.places[*place as usize];
        let (mut record, mut at) = (u128::from(cluster), u8::BITS);
        for (code, bits) in codes.iter().zip(header.bits).take(header.components()) {
            record |= u128::from(*code) << at;
            at += u32::from(bits);
        }
        out.extend(&record.to_le_bytes()[..record_bytes]);
    }
    out
}
