//! Pushed bytes: the same rows whatever the chunks, and the files that the reader of whole ones accepts.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::container::{Crc, crc32};
use subsurf_decoder::push::{Piece, PushReader};
use subsurf_decoder::{File, ReadError, Section};
use subsurf_fuzz::mutate;

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::BssrdfHeader)
});

fuzz_target!(|input: &[u8]| {
    // Chunks of a length that the input decides.
    let chunk = 1 + crc32(input) as usize % 97;
    let (whole, pushed) = (push(input, usize::MAX), push(input, chunk));
    assert_eq!(format!("{whole:?}"), format!("{pushed:?}"), "in chunks of {chunk}");
    let ((_, end), file) = (whole, File::parse_with(input, Crc::Skip));
    match (end, file) {
        (Ok(()), Ok(_)) => {}
        // Sums of ratios are no part of what is checked row by row.
        (Ok(()), Err(error)) => {
            assert!(matches!(error, ReadError::BadNumber { section: Section::MixtureRatios, .. }), "{error}");
        }
        (Err(error), file) => {
            let is_of_pushes = matches!(error, ReadError::OutOfOrder { .. } | ReadError::BufferTooSmall { .. });
            assert!(file.is_err() || is_of_pushes, "{error}");
        }
    }
});

/// Number of pieces and CRC-32 of all rows, and how it ended.
fn push(input: &[u8], chunk: usize) -> ((usize, u32), Result<(), ReadError>) {
    let mut reader = PushReader::<4096>::with_crc(Crc::Skip);
    let (mut count, mut rows) = (0, 0);
    let on_piece = &mut |piece: Piece<'_>| {
        count += 1;
        if let Piece::Row(row) = piece {
            rows = crc32(row.bytes) ^ u32::rotate_left(rows, 1);
        }
    };
    let mut end = Ok(());
    for bytes in input.chunks(chunk) {
        end = end.and_then(|()| reader.push(bytes, &mut *on_piece));
    }
    ((count, rows), end.and_then(|()| reader.finish()))
}
