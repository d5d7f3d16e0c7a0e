//! Transfers: weights of lights, tables and exitance of any file that is accepted.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::container::Crc;
use subsurf_decoder::transfer::LightWeights;
use subsurf_decoder::{Section, Transfer};
use subsurf_fuzz::{Arguments, check_error, mutate};

/// Most lights whose weights are solved for.
const MOST_LIGHTS: usize = 12;
/// Vertices that are looked at.
const VERTICES: usize = 3;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::TransferHeader)
});

fuzz_target!(|input: &[u8]| {
    match Transfer::parse_with(input, Crc::Skip) {
        Err(error) => check_error(error, input),
        Ok(transfer) => relight(&transfer, &mut Arguments::behind_file(input)),
    }
});

fn relight(transfer: &Transfer<'_>, arguments: &mut Arguments<'_>) {
    let header = transfer.header();
    let (lights, channels) = (usize::from(header.lights), usize::from(header.channels));
    for (light, is_last) in (0..lights).map(|light| (light, light + 1 == lights)) {
        let [x, y, z] = [0, 1, 2].map(|axis| transfer.lights().get(3 * light + axis).expect("a light"));
        assert!((x * x + y * y + z * z - 1.0).abs() < 1.001e-3, "light {light}: {x} {y} {z}");
        assert!(!is_last || transfer.lights().get(3 * lights).is_none(), "as many as the header says");
    }
    let towards = arguments.direction();
    let mut weights = vec![1.0; lights];
    if lights <= MOST_LIGHTS {
        let mut buffer = vec![0.0; LightWeights::buffer_len(lights)];
        if let Some(between) = LightWeights::new(transfer.lights(), &mut buffer) {
            between.at(towards, &mut weights);
            if towards.iter().all(|x| x.abs() <= 1.0) {
                let (sum, most) = weights.iter().fold((0.0, 1.0_f32), |(sum, most), w| (sum + w, most.max(w.abs())));
                assert!((sum - 1.0).abs() < 1e-3 * most, "{weights:?}");
            }
        }
    }
    let is_bounded = weights.iter().all(|weight| weight.abs() < 1e6);
    let mut table = vec![f32::NAN; header.table_len()];
    transfer.light_table(&weights, &mut table);
    assert!(!is_bounded || table.iter().all(|value| value.is_finite()), "{table:?}");

    // Of any vertex, of the last, and of none.
    let vertices = header.vertices as usize;
    for first in [arguments.below(vertices), vertices - 1, vertices, usize::MAX - arguments.below(9)] {
        let mut exitance = vec![f32::NAN; VERTICES * channels + arguments.below(channels)];
        transfer.exitance(&table, first, &mut exitance);
        assert!(!is_bounded || exitance.iter().all(|q| q.is_finite()), "{first}: {exitance:?}");
        let are_there = vertices.saturating_sub(first).min(VERTICES);
        assert!(exitance[channels * are_there..].iter().all(|q| *q == 0.0), "{first}: {exitance:?}");
    }
    // Room that is too short does no harm.
    let short = arguments.below(table.len());
    transfer.light_table(&weights[..short.min(lights)], &mut table[..short]);
    transfer.exitance(&table[..short], 0, &mut [0.0; VERTICES]);
}
