//! Loops on all cores. Rayon's iterators are compiled for every closure, several times each. Here they are compiled once, for [`run`]; what
//! differs between calls is a plain loop. Only loops that end at the first error, keep a buffer for each thread, or look for a least value use Rayon's own.

use std::sync::{Mutex, PoisonError};

use rayon::prelude::*;

/// Blocks for each thread: enough that those with much to do do not leave others waiting.
const BLOCKS_PER_THREAD: usize = 8;

/// Results of `of` for the numbers below `count`, in order.
pub(crate) fn map<T: Send>(count: usize, of: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let blocks = blocks(count);
    let results: Vec<Mutex<Vec<T>>> = (0..blocks).map(|_| Mutex::default()).collect();
    run(blocks, &|block| {
        let result = (block * count / blocks..(block + 1) * count / blocks).map(&of).collect();
        *results[block].lock().unwrap_or_else(PoisonError::into_inner) = result;
    });
    let mut all = Vec::with_capacity(count);
    for result in results {
        all.append(&mut result.into_inner().unwrap_or_else(PoisonError::into_inner));
    }
    all
}

/// Shows each chunk of `len` values and its number to `of`; its results, in order.
///
/// # Panics
/// If `len` is 0.
pub(crate) fn map_chunks<T: Send, U: Send>(
    all: &mut [T],
    len: usize,
    of: impl Fn(usize, &mut [T]) -> U + Sync,
) -> Vec<U> {
    let count = all.len().div_ceil(len);
    let chunks = count.div_ceil(blocks(count).max(1)).max(1);
    let blocks: Vec<Mutex<&mut [T]>> = all.chunks_mut(chunks * len).map(Mutex::new).collect();
    let results = map(blocks.len(), |block| {
        let mut values = blocks[block].lock().unwrap_or_else(PoisonError::into_inner);
        values.chunks_mut(len).enumerate().map(|(k, chunk)| of(block * chunks + k, chunk)).collect::<Vec<U>>()
    });
    let mut all = Vec::with_capacity(count);
    results.into_iter().for_each(|mut result| all.append(&mut result));
    all
}

/// [`map_chunks`] without results.
pub(crate) fn for_chunks<T: Send>(all: &mut [T], len: usize, of: impl Fn(usize, &mut [T]) + Sync) {
    map_chunks(all, len, of);
}

fn blocks(count: usize) -> usize {
    count.min(BLOCKS_PER_THREAD * rayon::current_num_threads())
}

fn run(blocks: usize, work: &(dyn Fn(usize) + Sync)) {
    (0..blocks).into_par_iter().for_each(work);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_number_and_every_chunk_comes_once_and_in_order() {
        for count in [0, 1, 2, 63, 64, 65, 1_000] {
            assert_eq!(map(count, |k| k), (0..count).collect::<Vec<_>>());
            for len in [1, 3, 64, 2_000] {
                let mut values: Vec<usize> = (0..count).collect();
                let firsts = map_chunks(&mut values, len, |number, chunk| {
                    assert!(chunk.len() == len || (number + 1) * len > count, "chunk {number} of {count}");
                    chunk.iter_mut().for_each(|value| *value += number);
                    chunk[0]
                });
                assert!(values.iter().enumerate().all(|(k, value)| *value == k + k / len), "{count} by {len}");
                assert!(firsts.iter().enumerate().all(|(k, first)| *first == k * len + k), "{count} by {len}");
            }
        }
    }
}
