//! How many directions of each pair were measured.

use super::read::{ALL_CHANNELS, BLOCK_ROWS};
use crate::bssrdf::window::{Geometry, Ring};
use crate::math::lanes::{Lanes, ZERO};
use crate::math::parallel;

/// Lanes of a packed count.
pub(super) static COUNTS: [Lanes; 64] = {
    let mut table = [ZERO; 64];
    let mut packed = 0;
    while packed < 64 {
        let mut c = 0;
        while c < 3 {
            table[packed][c] = ((packed >> (2 * c)) & 3) as f32;
            c += 1;
        }
        packed += 1;
    }
    table
};

/// n of every pixel and offset in ring order, from the channels measured in each direction; `None` if nothing is missing.
pub(super) fn counts(geometry: &Geometry, rings: &[Ring], measured: &[Option<Vec<u8>>]) -> Option<Vec<u8>> {
    if measured.iter().all(Option::is_none) {
        return None;
    }
    let places = rings.iter().map(|ring| ring.offsets.len()).sum::<usize>();
    let width = geometry.size[0];
    let channels = |pixel: usize, place: usize| {
        let (block, row) = (pixel / width / BLOCK_ROWS, pixel / width % BLOCK_ROWS);
        let at = (row * width + pixel % width) * places + place;
        measured[block].as_ref().map_or(ALL_CHANNELS, |measured| measured[at])
    };
    // Three bits spread to two bits each.
    let spread = |channels: u8| (channels & 1) | (channels & 2) << 1 | (channels & 4) << 2;
    let mut counts = vec![0; geometry.pixels() * places];
    parallel::for_chunks(&mut counts, places, |pixel, counts| {
        let offsets = rings.iter().flat_map(|ring| &ring.offsets);
        for (count, offset) in counts.iter_mut().zip(offsets) {
            if let Some(other) = geometry.neighbour(pixel, offset.step) {
                let back = geometry.place(geometry.way_back(pixel, offset.step));
                *count = spread(channels(pixel, offset.place)) + spread(channels(other, back));
            }
        }
    });
    Some(counts)
}
