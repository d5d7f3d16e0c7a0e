//! Limits of transfers: what is allowed up to the last value.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use super::parts::{HEADER, bits, file, zeros};
use crate::common::assemble;
use subsurf_decoder::transfer::TransferHeader;
use subsurf_decoder::{ReadError, Section, Transfer};

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
