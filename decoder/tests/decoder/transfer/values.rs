//! Values of transfers: what the numbers of a file stand for.
#![allow(clippy::cast_possible_truncation, reason = "numbers of tests are small")]

use super::parts::{HEADER, LIGHTS, Tables, bits, file, zeros};
use subsurf_decoder::Transfer;
use subsurf_decoder::transfer::{LightWeights, TransferHeader};

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
