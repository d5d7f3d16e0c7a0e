//! Small transfer files, made of a header and tables.

use crate::common::{assemble, floats};
use subsurf_decoder::transfer::TransferHeader;

/// Four lights, two clusters of one component, three vertices, all of one channel.
pub(super) const HEADER: TransferHeader = TransferHeader {
    channels: 1,
    lights: 4,
    clusters: 2,
    tail_nodes: 2,
    vertices: 3,
    positions_crc: 1,
    triangles_crc: 2,
    radius_mm: 2.0,
    eta: 1.5,
    scale: [0.5, 1.0, 2.0],
    bits: bits(&[8]),
    axes: 3,
};

/// Bits of components, and zeros after them.
pub(super) const fn bits(first: &[u8]) -> [u8; 16] {
    let mut all = [0; 16];
    let mut k = 0;
    while k < first.len() {
        all[k] = first[k];
        k += 1;
    }
    all
}

/// Corners of a tetrahedron and light from above would be four lights; these are along axes.
pub(super) const LIGHTS: [f32; 12] = [1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// A file's tables.
pub(super) struct Tables {
    pub(super) lights: Vec<f32>,
    pub(super) axes: Vec<i8>,
    pub(super) ranges: Vec<f32>,
    pub(super) means: Vec<u16>,
    pub(super) bases: Vec<i8>,
    pub(super) codes: Vec<u8>,
}

/// Tables of [`HEADER`], all of them zeros but the lights.
pub(super) fn zeros() -> Tables {
    Tables {
        lights: LIGHTS.to_vec(),
        axes: vec![0; 12],
        ranges: vec![0.0; 8],
        means: vec![0; 6],
        bases: vec![0; 6],
        codes: vec![0; 6],
    }
}

pub(super) fn file(header: TransferHeader, tables: &Tables) -> Vec<u8> {
    let means: Vec<u8> = tables.means.iter().flat_map(|mean| mean.to_le_bytes()).collect();
    let [axes, bases] =
        [&tables.axes, &tables.bases].map(|of| of.iter().map(|x| x.cast_unsigned()).collect::<Vec<u8>>());
    assemble(&[
        (b"XFER", &header.to_bytes()),
        (b"XDIR", &floats(&tables.lights)),
        (b"XAXS", &axes),
        (b"XRNG", &floats(&tables.ranges)),
        (b"XMEA", &means),
        (b"XBAS", &bases),
        (b"XVTX", &tables.codes),
        (b"TAIL", &floats(&[0.5, 0.5, 0.5, 0.0, 0.0, 0.0])),
    ])
}
