//! The reader of pushed bytes against the reader of whole files: the same refusals, whatever the chunks.

use crate::common::push::{CHUNKS, OTHER_ORDER, Seen, basis, files, is_same, push, result, sound_files};
use crate::common::rebuilt;
use crate::common::{btf, seal_all};
use proptest::prelude::*;
use subsurf_decoder::bssrdf::layout::HEADER_BYTES;
use subsurf_decoder::container::Crc;
use subsurf_decoder::push::PushReader;
use subsurf_decoder::{File, ReadError, Section};

#[test]
fn broken_files_are_refused_for_the_same_reason() {
    let mut refused = 0;
    for (name, bytes) in files() {
        let Err(error) = File::parse(&bytes) else { continue };
        for chunk in CHUNKS {
            let (_, found) = push::<4096>(&bytes, chunk, Crc::Check);
            assert!(is_same(found, Err(error)), "{name} in chunks of {chunk}: {found:?}, not {error:?}");
        }
        refused += 1;
    }
    assert!(refused > 25, "{refused} broken files");
}

#[test]
fn a_cut_at_every_length_is_an_error_at_the_end() {
    for (name, bytes) in sound_files().filter(|(_, bytes)| bytes.len() < 4_000) {
        for length in 0..File::parse(&bytes).unwrap().container().file().len() {
            let expected = File::parse(&bytes[..length]).map(drop);
            let (_, found) = push::<4096>(&bytes[..length], 64, Crc::Check);
            assert!(matches!(found, Err(ReadError::Truncated { .. })), "{name} cut to {length}: {found:?}");
            assert_eq!(found, expected, "{name} cut to {length}");
        }
    }
}

/// Whether a refusal is one that differs, as the module's documentation says: a file's length is compared with the bytes that came after all else, sizes
/// of all sections before any value, and ratios of a pixel are not added up.
fn is_exception(found: Result<(), ReadError>, expected: Result<(), ReadError>) -> bool {
    match (found, expected) {
        (Err(ReadError::Checksum { section: Section::FileHeader, .. }), Err(ReadError::Truncated { .. })) => true,
        (Err(ReadError::WrongSize { .. }), Err(ReadError::IndexOutOfRange { .. })) => true,
        (Ok(()), Err(ReadError::BadNumber { section: Section::MixtureRatios, min, max, .. })) => min > 0.9 && max > 1.0,
        _ => false,
    }
}

#[test]
fn damage_is_refused_for_the_same_reason() {
    /// A file of each kind.
    const FILES: [&str; 9] = [
        "format_example.subsurf",
        "one_pixel.subsurf",
        "three_bases.subsurf",
        "palette.subsurf",
        "basis",
        "kernel_example.subsurf",
        "transfer_example.subsurf",
        "nested",
        "factored",
    ];
    let (mut exceptions, mut count) = (0, 0);
    for (name, bytes) in files().into_iter().filter(|(name, _)| FILES.contains(&&name[..])) {
        let sections = usize::from(bytes[12]);
        count += 1;
        for at in 0..bytes.len() {
            let mut bad = bytes.clone();
            // Another bit of every byte.
            bad[at] ^= 1 << (5 * at % 8);
            for (is_sealed, crc) in [(false, Crc::Check), (false, Crc::Skip), (true, Crc::Check)] {
                if is_sealed {
                    // The same damage by someone who recomputes the CRCs.
                    seal_all(&mut bad, sections);
                }
                let expected = File::parse_with(&bad, crc).map(drop);
                let found = result(&bad, crc);
                exceptions += usize::from(is_exception(found, expected));
                let is_due = is_same(found, expected) || is_exception(found, expected);
                assert!(is_due, "{name}, byte {at}: {found:?}, not {expected:?}");
            }
        }
    }
    assert!(exceptions > 0, "some are met");
    assert_eq!(count, FILES.len(), "all are there");
}

#[test]
fn wrong_values_and_lengths_of_sections_are_refused_for_the_same_reason() {
    type Change = fn(&mut Vec<u8>);
    // Not a number, an index beyond any table, at either end; a byte less and one more.
    let changes: [Change; 4] = [
        |section| section.iter_mut().take(4).for_each(|byte| *byte = 0xFF),
        |section| section.iter_mut().rev().take(4).for_each(|byte| *byte = 0xFF),
        |section| section.truncate(section.len().saturating_sub(1)),
        |section| section.push(0),
    ];
    let mut refused = 0;
    for (name, bytes) in sound_files() {
        for (number, (which, change)) in (0..usize::from(bytes[12]))
            .flat_map(|number| changes.iter().enumerate().map(move |change| (number, change)))
        {
            let bad = rebuilt(&bytes, |sections| change(&mut sections[number].1));
            let expected = File::parse(&bad).map(drop);
            let found = result(&bad, Crc::Check);
            let is_due = is_same(found, expected) || is_exception(found, expected);
            assert!(is_due, "{name}, change {which} of section {number}: {found:?}, not {expected:?}");
            refused += usize::from(found.is_err());
        }
    }
    assert!(refused > 300, "{refused} of them are refused");
}

#[test]
fn missing_sections_are_named() {
    for (name, bytes) in sound_files() {
        for number in 0..usize::from(bytes[12]) {
            let bad = rebuilt(&bytes, |sections| drop(sections.remove(number)));
            let expected = File::parse(&bad).map(drop);
            let found = result(&bad, Crc::Check);
            assert!(is_same(found, expected), "{name} without section {number}: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn sizes_that_are_cut_say_what_they_take() {
    for (bytes, kind) in [(btf::factored(), b"FACT"), (btf::nested(), b"BOOK")] {
        for length in 0..130 {
            let bad = rebuilt(&bytes, |sections| {
                let (_, content) = sections.iter_mut().find(|(of, _)| of == kind).expect("the section");
                content.truncate(length);
            });
            let expected = File::parse(&bad).map(drop);
            let found = result(&bad, Crc::Check);
            assert!(is_same(found, expected), "{length} bytes: {found:?}, not {expected:?}");
        }
    }
}

#[test]
fn numbers_of_a_basis_at_their_limits() {
    // Two widths, six weights, six factors.
    for (number, limit) in [(2, 1e6), (7, 1e6), (8, 1e15_f32), (13, 1e15)] {
        for (value, is_allowed) in [(limit, true), (-limit, true), (limit.next_up(), false), (-limit.next_up(), false)]
        {
            let bytes = rebuilt(&basis(), |sections| {
                sections[4].1[4 + 4 * number..][..4].copy_from_slice(&value.to_le_bytes());
            });
            let found = result(&bytes, Crc::Check);
            assert_eq!(found.is_ok(), is_allowed, "number {number} is {value}: {found:?}");
            assert_eq!(found, File::parse(&bytes).map(drop), "number {number} is {value}");
        }
    }
}

#[test]
fn a_buffer_that_is_too_small_says_what_it_takes() {
    let bytes = crate::common::example();
    let (_, end) = push::<27>(&bytes, 7, Crc::Check);
    let section = Section::FileHeader;
    assert_eq!(end, Err(ReadError::BufferTooSmall { section, need_bytes: 124, have_bytes: 27 }));
    assert_eq!(end.unwrap_err().to_string(), "file header: takes a buffer of 124 bytes, there are 27");
    // The header is the longest row of so small a patch.
    let Err(ReadError::BufferTooSmall { section: Section::BssrdfHeader, need_bytes, have_bytes: 124 }) =
        push::<124>(&bytes, 7, Crc::Check).1
    else {
        panic!("a row takes more");
    };
    assert_eq!(need_bytes, 124 + HEADER_BYTES as u64);
    let (_, end) = push::<{ 124 + HEADER_BYTES }>(&bytes, 7, Crc::Check);
    assert_eq!(end, Ok(()));
}

#[test]
fn rows_before_what_they_depend_on_are_refused() {
    // Sections of sound files in another order, which the reader of whole files takes.
    let swapped = |bytes: &[u8], a: Section, b: Section| {
        let bytes = rebuilt(bytes, |sections| {
            let [a, b] =
                [a, b].map(|of| sections.iter().position(|(kind, _)| *kind == of.kind()).expect("the section"));
            sections.swap(a, b);
        });
        assert!(File::parse(&bytes).is_ok(), "{a} and {b} in another order");
        push::<4096>(&bytes, 64, Crc::Check).1
    };
    let (nested, factored, example, with_basis) = (btf::nested(), btf::factored(), crate::common::example(), basis());
    for (bytes, section, needs) in [
        (&example, Section::BaseProfiles, Section::BssrdfHeader),
        (&with_basis, Section::SeparableBasis, Section::BssrdfHeader),
        (&nested, Section::Materials, Section::BtfHeader),
        (&nested, Section::CodebookSizes, Section::Materials),
        (&nested, Section::Codebook { book: 6, stage: 0 }, Section::CodebookSizes),
        (&factored, Section::TuckerHeader, Section::Materials),
        (&factored, Section::Axes, Section::TuckerHeader),
    ] {
        assert_eq!(swapped(bytes, section, needs), Err(ReadError::OutOfOrder { section, needs }));
    }
    assert_eq!(swapped(&example, Section::MixtureRatios, Section::BaseIndices), Ok(()), "these are as they like");
    let error = swapped(&example, Section::BaseProfiles, Section::BssrdfHeader).unwrap_err().to_string();
    let said = "PROF (base scattering profiles): stands before BSSR (material header), which is needed first";
    assert_eq!(error, said);
    let (_, vector) = files().into_iter().find(|(name, _)| name == OTHER_ORDER).expect("the vector");
    let (section, needs) = (Section::BaseIndices, Section::BssrdfHeader);
    assert!(File::parse(&vector).is_ok(), "the reader of whole files takes any order");
    assert_eq!(push::<4096>(&vector, 64, Crc::Check).1, Err(ReadError::OutOfOrder { section, needs }));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn chunks_of_any_sizes_make_no_difference(
        which in 0_usize..4,
        changes in proptest::collection::vec((8_usize..3_000, any::<u8>()), 0..4),
        sizes in proptest::collection::vec(0_usize..300, 1..20).prop_filter("some bytes", |sizes| sizes.iter().sum::<usize>() > 0),
    ) {
        let files = [crate::common::example(), basis(), btf::nested(), btf::factored()];
        let mut file = files[which].clone();
        let length = file.len();
        for (at, value) in changes {
            file[at % length] = value;
        }
        let sections = usize::from(file[12]).min((length - 28) / 24);
        seal_all(&mut file, sections);
        let (expected, end) = push::<4096>(&file, usize::MAX, Crc::Check);
        let (mut seen, mut reader, mut rest) = (Seen::default(), PushReader::<4096>::new(), &file[..]);
        let mut found = Ok(());
        for size in sizes.into_iter().cycle() {
            let (chunk, after) = rest.split_at(size.min(rest.len()));
            found = reader.push(chunk, |piece| seen.take(piece));
            rest = after;
            if found.is_err() || rest.is_empty() {
                break;
            }
        }
        let found = found.and_then(|()| reader.finish());
        prop_assert!(is_same(found, end), "{found:?}, not {end:?}");
        prop_assert_eq!(format!("{seen:?}"), format!("{expected:?}"));
    }
}
