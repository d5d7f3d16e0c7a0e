//! Limits and values of transfers: what is allowed up to the last value, and what the numbers stand for.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use crate::common::{assemble, floats};
use subsurf_decoder::transfer::{LightWeights, TransferHeader};
use subsurf_decoder::{ReadError, Section, Transfer};

/// Four lights, two clusters of one component, three vertices, all of one channel.
const HEADER: TransferHeader = TransferHeader {
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
const fn bits(first: &[u8]) -> [u8; 16] {
    let mut all = [0; 16];
    let mut k = 0;
    while k < first.len() {
        all[k] = first[k];
        k += 1;
    }
    all
}

/// Corners of a tetrahedron and light from above would be four lights; these are along axes.
const LIGHTS: [f32; 12] = [1.0, 0.0, 0.0, -1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];

/// Error of a file that ends with its header.
fn refusal(header: TransferHeader) -> ReadError {
    Transfer::parse(&assemble(&[(b"XFER", &header.to_bytes())])).unwrap_err()
}

#[test]
fn fields_of_the_header() {
    type Change = fn(&mut TransferHeader, u32);
    let cases: [(&str, Change, &[u32], &[u32]); 6] = [
        ("channels", |h, x| h.channels = x as u8, &[0, 2, 4], &[1, 3]),
        ("lights", |h, x| h.lights = x as u16, &[0, 3, 1_025], &[4, 1_024]),
        ("clusters", |h, x| h.clusters = x as u16, &[0, 257], &[1, 256]),
        ("tail_nodes", |h, x| h.tail_nodes = x as u16, &[0, 1, 1_025], &[2, 1_024]),
        ("axes", |h, x| h.axes = x as u16, &[0, 257], &[1, 256]),
        ("vertices", |h, x| h.vertices = x, &[0, (1 << 26) + 1], &[1, 1 << 26]),
    ];
    for (name, change, refused, allowed) in cases {
        let error_of = |value: u32| {
            let mut header = HEADER;
            change(&mut header, value);
            refusal(header)
        };
        for &value in refused {
            let error = error_of(value);
            let is_due = matches!(error, ReadError::BadField { section: Section::TransferHeader, value: found, .. } if found == value);
            assert!(is_due, "{name} {value}: {error}");
        }
        for &value in allowed {
            assert_eq!(error_of(value), ReadError::Missing { section: Section::Lights }, "{name} {value}");
        }
    }
}

#[test]
fn bits_of_components() {
    // Bits, and the one that is refused.
    let cases: [(&[u8], Option<usize>); 10] = [
        (&[1], None),
        (&[12], None),
        (&[12; 10], None),
        (&[8; 15], None),
        (&[1; 16], None),
        (&[], Some(0)),
        (&[13], Some(0)),
        (&[3, 0, 1], Some(2)),
        // 8 + 120 bits are a record; one more is too many.
        (&[12, 12, 12, 12, 12, 12, 12, 12, 12, 12, 1], Some(10)),
        (&[8; 16], Some(15)),
    ];
    for (first, refused) in cases {
        let error = refusal(TransferHeader { bits: bits(first), ..HEADER });
        let offset = |at: usize| (24 + 24 + 4 + HEADER.to_bytes().len() - 18 + at) as u64;
        match refused {
            None => assert_eq!(error, ReadError::Missing { section: Section::Lights }, "{first:?}"),
            Some(at) => {
                let value = u32::from(bits(first)[at]);
                let due = ReadError::BadField { section: Section::TransferHeader, offset: offset(at), value };
                assert_eq!(error, due, "{first:?}");
            }
        }
    }
}

#[test]
fn lengths_scales_and_refractive_index() {
    type Change = fn(&mut TransferHeader, f32);
    let cases: [(Change, [f32; 2]); 5] = [
        (|h, x| h.radius_mm = x, [1e-6, 1e6]),
        (|h, x| h.eta = x, [1.0, 4.0]),
        (|h, x| h.scale[0] = x, [1e-12, 1e6]),
        (|h, x| h.scale[1] = x, [1e-12, 1e6]),
        (|h, x| h.scale[2] = x, [1e-12, 1e6]),
    ];
    for ((change, [min, max]), at) in cases.into_iter().zip((20..).step_by(4)) {
        let error_of = |value: f32| {
            let mut header = HEADER;
            change(&mut header, value);
            refusal(header)
        };
        for value in [min, max] {
            assert_eq!(error_of(value), ReadError::Missing { section: Section::Lights }, "{value}");
        }
        for value in [min.next_down(), max.next_up()] {
            let offset = 24 + 24 + 4 + at;
            assert_eq!(
                error_of(value),
                ReadError::BadNumber { section: Section::TransferHeader, offset, value, min, max }
            );
        }
    }
}

#[test]
fn sizes_follow_from_the_header() {
    let header =
        TransferHeader { channels: 3, lights: 5, clusters: 7, tail_nodes: 11, bits: bits(&[4, 5]), axes: 6, ..HEADER };
    assert_eq!((header.components(), header.record_bytes(), header.table_len()), (2, 3, 63));
    let records = [&[8][..], &[9], &[1], &[12; 10]].map(|first| TransferHeader { bits: bits(first), ..header });
    assert_eq!(records.map(|header| header.record_bytes()), [2, 3, 2, 16], "rounded up");
    let sizes = [
        (Section::TransferHeader, HEADER.to_bytes().len() as u64),
        (Section::Lights, 60),
        (Section::ClusterRanges, 168),
        (Section::LightAxes, 90),
        (Section::ClusterMeans, 84),
        (Section::ClusterBases, 84),
        (Section::VertexCodes, 9),
        (Section::KernelTail, 132),
        (Section::BaseProfiles, 0),
    ];
    for (section, bytes) in sizes {
        assert_eq!(header.section_bytes(section), bytes, "{section}");
    }
}

/// A file's tables.
struct Tables {
    lights: Vec<f32>,
    axes: Vec<i8>,
    ranges: Vec<f32>,
    means: Vec<u16>,
    bases: Vec<i8>,
    codes: Vec<u8>,
}

/// Tables of [`HEADER`], all of them zeros but the lights.
fn zeros() -> Tables {
    Tables {
        lights: LIGHTS.to_vec(),
        axes: vec![0; 12],
        ranges: vec![0.0; 8],
        means: vec![0; 6],
        bases: vec![0; 6],
        codes: vec![0; 6],
    }
}

fn file(header: TransferHeader, tables: &Tables) -> Vec<u8> {
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

#[test]
fn directions_are_of_length_1() {
    let first = (24 + 24 * 8 + 4 + HEADER.to_bytes().len()).next_multiple_of(4) as u64;
    let error_of = |light: usize, direction: [f32; 3]| {
        let mut tables = zeros();
        tables.lights[3 * light..3 * light + 3].copy_from_slice(&direction);
        Transfer::parse(&file(HEADER, &tables)).err()
    };
    for direction in [[0.0, 1.0004, 0.0], [0.0, 0.0, -0.9996], [0.6, 0.0, 0.8]] {
        assert_eq!(error_of(3, direction), None, "{direction:?}");
    }
    for (light, direction) in [(0, [1.0006, 0.0, 0.0]), (1, [0.0, 0.9994, 0.0]), (3, [0.0; 3]), (2, [0.7, 0.7, 0.7])] {
        let square = direction.iter().map(|x| x * x).sum::<f32>();
        let error = error_of(light, direction).unwrap();
        let ReadError::BadNumber { section: Section::Lights, offset, value, min, max } = error else {
            panic!("{error}")
        };
        assert_eq!(offset, first + 12 * light as u64, "the light");
        let is_square = (value - square).abs() < 1e-6 && !(min..=max).contains(&value);
        assert!(
            is_square || !(-1.001..=1.001).contains(&value),
            "the square of its length, or a number too large: {error}"
        );
    }
}

#[test]
fn ranges_and_clusters() {
    let first = (24 + 24 * 8 + 4 + HEADER.to_bytes().len()).next_multiple_of(4) as u64 + 48 + 12;
    for (at, value, is_allowed) in [
        (0, -1_000.0, true),
        (0, 1_000.0, true),
        (0, 1_000.0_f32.next_up(), false),
        (6, (-1_000.0_f32).next_down(), false),
        (1, 0.0, true),
        (1, 1_000.0, true),
        (1, -f32::from_bits(1), false),
        (7, 1_000.0_f32.next_up(), false),
    ] {
        let mut tables = zeros();
        tables.ranges[at] = value;
        let error = Transfer::parse(&file(HEADER, &tables)).err();
        let min = if at % 2 == 0 { -1_000.0 } else { 0.0 };
        let offset = first + 4 * at as u64;
        let due = ReadError::BadNumber { section: Section::ClusterRanges, offset, value, min, max: 1_000.0 };
        assert_eq!(error, (!is_allowed).then_some(due), "{value} as number {at}");
    }
    for (vertex, cluster) in [(0, 1), (2, 1), (0, 2), (2, 2), (1, 255)] {
        let mut tables = zeros();
        tables.codes[2 * vertex] = cluster;
        let error = Transfer::parse(&file(HEADER, &tables)).err();
        let offset = first + 32 + 12 + 8 + 2 * vertex as u64;
        let due = ReadError::IndexOutOfRange { section: Section::VertexCodes, offset, index: cluster.into(), len: 2 };
        assert_eq!(error, (cluster >= 2).then_some(due), "cluster {cluster} of vertex {vertex}");
    }
}

#[test]
fn exitance_of_three_channels() {
    // Two components of 4 and 7 bits, in records of three bytes.
    let header = TransferHeader { channels: 3, bits: bits(&[4, 7]), axes: 5, ..HEADER };
    let record = |cluster: u32, first: u32, second: u32| cluster | first << 8 | second << 12;
    let vertices = [(1, 3, 100), (0, 15, 1), (1, 0, 127)];
    let tables = Tables {
        lights: LIGHTS.to_vec(),
        axes: (0..60_i16).map(|k| (k * 7 % 17 - 8) as i8).collect(),
        // Offset and step of the mean and of both components, for both clusters.
        ranges: vec![0.5, 0.25, -1.0, 0.125, 0.75, 0.5, -0.5, 1.0, 2.0, 0.25, 0.0, 0.0625],
        means: (0..10_u16).map(|k| k * 7 % 11).collect(),
        bases: (0..20_i16).map(|k| (k * 5 % 13 - 6) as i8).collect(),
        codes: vertices.iter().flat_map(|(m, a, b)| record(*m, *a, *b).to_le_bytes()[..3].to_vec()).collect(),
    };
    let bytes = file(header, &tables);
    let transfer = Transfer::parse(&bytes).unwrap();
    let weights = [0.5, -0.25, 1.0, 0.125];
    let mut table = vec![f32::NAN; header.table_len()];
    transfer.light_table(&weights, &mut table);
    let mut found = [f32::NAN; 11];
    transfer.exitance(&table, 0, &mut found);
    for (vertex, (cluster, first, second)) in vertices.into_iter().enumerate() {
        let range = |row: usize| [0, 1].map(|k| f64::from(tables.ranges[6 * cluster as usize + 2 * row + k]));
        for c in 0..3 {
            let mut due = 0.0;
            for (light, weight) in weights.into_iter().enumerate() {
                let coefficient = |k: usize, code: u32| range(k + 1)[0] + range(k + 1)[1] * f64::from(code);
                for axis in 0..5 {
                    let mean = f64::from(tables.means[5 * cluster as usize + axis]);
                    let basis = |k: usize| f64::from(tables.bases[5 * (2 * cluster as usize + k) + axis]);
                    let along = range(0)[0]
                        + range(0)[1] * mean
                        + coefficient(0, first) * basis(0)
                        + coefficient(1, second) * basis(1);
                    due += f64::from(weight) * f64::from(tables.axes[5 * (4 * c + light) + axis]) * along;
                }
            }
            due *= f64::from(header.scale[c]);
            let value = f64::from(found[3 * vertex + c]);
            assert!(
                (value - due).abs() < 1e-4 * due.abs().max(1.0),
                "vertex {vertex}, channel {c}: {value}, not {due}"
            );
        }
    }
    assert_eq!(found[9..], [0.0; 2], "there are no more vertices");
    // From the second vertex on, and weights that are missing.
    let mut second = [f32::NAN; 3];
    transfer.exitance(&table, 1, &mut second);
    assert_eq!(second, found[3..6]);
    let mut shorter = vec![f32::NAN; header.table_len()];
    transfer.light_table(&weights[..2], &mut shorter);
    let mut with_zeros = table.clone();
    transfer.light_table(&[0.5, -0.25, 0.0, 0.0], &mut with_zeros);
    assert_eq!(shorter, with_zeros, "what is missing is 0");
    // Weights beyond the lights do not count, numbers beyond the table stay as they are.
    let mut longer = vec![7.0; header.table_len() + 5];
    transfer.light_table(&[0.5, -0.25, 1.0, 0.125, 9.0], &mut longer);
    assert_eq!((&longer[..table.len()], &longer[table.len()..]), (&table[..], &[7.0; 5][..]));
}

#[test]
fn the_last_of_256_axes_counts() {
    let header = TransferHeader { axes: 256, ..HEADER };
    let mut tables = Tables {
        axes: vec![0; 4 * 256],
        ranges: vec![0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0],
        means: vec![0; 2 * 256],
        bases: vec![0; 2 * 256],
        ..zeros()
    };
    (tables.axes[255], tables.axes[4 * 256 - 1], tables.means[255]) = (-3, 2, 6);
    let bytes = file(header, &tables);
    let transfer = Transfer::parse(&bytes).unwrap();
    let mut table = vec![f32::NAN; header.table_len()];
    transfer.light_table(&[1.0, 0.0, 0.0, 0.25], &mut table);
    // s Σ_j w_j x_j μ = 0.5 · (−3 + 0.25 · 2) · 0.5 · 6.
    assert_eq!(table, [-3.75, 0.0, 0.0, 0.0]);
}

#[test]
fn codes_reach_over_the_middle_of_a_record() {
    // Ten components of 12 bits after the cluster: the fifth begins at bit 56 and ends at bit 68.
    let header = TransferHeader { bits: bits(&[12; 10]), ..HEADER };
    let codes: [u16; 10] = [1, 4_095, 0, 2_048, 0x0A5, 0xF0F, 7, 0x800, 0x7FF, 0xABC];
    let record = codes.iter().rev().fold(0_u128, |record, code| record << 12 | u128::from(*code)) << 8 | 1;
    let tables = Tables {
        ranges: vec![0.0; 44],
        bases: vec![0; 60],
        codes: [record.to_le_bytes(), [0; 16], [0xFF; 16].map(|_| 0)].concat(),
        ..zeros()
    };
    let bytes = file(header, &tables);
    let transfer = Transfer::parse(&bytes).unwrap();
    for (k, code) in codes.into_iter().enumerate() {
        // A table whose second cluster has a factor for one component alone.
        let mut table = vec![0.0; header.table_len()];
        (table[11], table[11 + 1 + k]) = (0.5, 2.0);
        let mut found = [f32::NAN];
        transfer.exitance(&table, 0, &mut found);
        assert_eq!(found, [0.5 + 2.0 * f32::from(code)], "component {k}");
    }
}

#[test]
fn weights_of_lights() {
    assert_eq!([1, 4, 200].map(LightWeights::buffer_len), [2, 14, 20_300]);
    let bytes = file(HEADER, &zeros());
    let transfer = Transfer::parse(&bytes).unwrap();
    let lights = transfer.lights();
    let mut buffer = [0.0; 14];
    assert!(LightWeights::new(lights, &mut buffer[..13]).is_none(), "no room");
    let between = LightWeights::new(lights, &mut buffer).unwrap();
    let mut weights = [0.0; 4];
    for (light, direction) in LIGHTS.chunks_exact(3).enumerate() {
        between.at([direction[0], direction[1], direction[2]], &mut weights);
        for (k, weight) in weights.iter().enumerate() {
            let due = if k == light { 1.0 } else { 0.0 };
            assert!((weight - due).abs() < 1e-5, "light {light}: {weights:?}");
        }
    }
    // Half way between y and z, as far from x as from −x: both have the same weight, and so have y and z.
    let half = 0.5_f32.sqrt();
    between.at([0.0, half, half], &mut weights);
    assert!((weights[0] - weights[1]).abs() < 1e-6 && (weights[2] - weights[3]).abs() < 1e-6, "{weights:?}");
    assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-6 && weights[2] > 0.5, "{weights:?}");
    let prepared = LightWeights::prepared(lights, &buffer).unwrap();
    let mut again = [0.0; 4];
    prepared.at([0.0, half, half], &mut again);
    assert_eq!(again, weights, "a buffer that was filled before");
    assert!(LightWeights::prepared(lights, &buffer[..13]).is_none(), "a part of a buffer");
    assert!(LightWeights::prepared(lights, &[0.0; 14]).is_none(), "nothing was filled in");
    let mut long = [5.0; 5];
    prepared.at([0.0, half, half], &mut long);
    assert_eq!(long, [5.0; 5], "room for more weights than there are lights");
    // Weights of smoothest interpolation (r² ln r, and a constant), solved here by Gaussian elimination.
    for (weight, due) in weights.iter().zip(thin_plate([0.0, half.into(), half.into()])) {
        assert!((f64::from(*weight) - due).abs() < 1e-4, "{weights:?} are not those of the covariance: {due}");
    }
}

/// Weights of [`LIGHTS`] by kriging with an unknown mean: C w + μ = c, Σ w = 1, with C = 1 + 2 cos θ + u ln u, u = 1 − cos θ.
fn thin_plate(towards: [f64; 3]) -> [f64; 4] {
    let light = |k: usize| [0, 1, 2].map(|axis| f64::from(LIGHTS[3 * k + axis]));
    let covariance = |a: [f64; 3], b: [f64; 3]| {
        let cosine: f64 = (0..3).map(|axis| a[axis] * b[axis]).sum();
        let u = 1.0 - cosine;
        1.0 + 2.0 * cosine + if u > 0.0 { u * u.ln() } else { 0.0 }
    };
    let mut rows = [[0.0; 6]; 5];
    for (i, row) in rows.iter_mut().enumerate() {
        for (j, value) in row.iter_mut().enumerate() {
            *value = match (i, j) {
                (0..=3, 0..=3) => covariance(light(i), light(j)),
                (0..=3, 5) => covariance(light(i), towards),
                (4, 4) => 0.0,
                _ => 1.0,
            };
        }
    }
    for pivot in 0..5 {
        let best = (pivot..5).max_by(|a, b| rows[*a][pivot].abs().total_cmp(&rows[*b][pivot].abs())).unwrap();
        rows.swap(pivot, best);
        let from = rows[pivot];
        for (number, row) in rows.iter_mut().enumerate().filter(|(number, _)| *number != pivot) {
            let factor = row[pivot] / from[pivot];
            assert!(factor.is_finite(), "row {number}");
            row.iter_mut().zip(from).for_each(|(value, from)| *value -= factor * from);
        }
    }
    [0, 1, 2, 3].map(|k| rows[k][5] / rows[k][k])
}
