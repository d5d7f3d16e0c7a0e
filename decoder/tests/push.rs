//! The reader of pushed bytes against the reader of whole files: the same rows, the same refusals, whatever the chunks.
#![cfg(all(feature = "push", feature = "transfer"))]

mod common;

use common::{btf, container, seal_all};
use subsurf_decoder::bssrdf::layout::HEADER_BYTES;
use subsurf_decoder::bssrdf::{BssrdfModel, Mixtures, Profiles};
use subsurf_decoder::container::Crc;
use subsurf_decoder::push::{Piece, PushReader};
use subsurf_decoder::{Content, File, ReadError, Section};

/// What chunks a file comes in.
const CHUNKS: [usize; 7] = [1, 2, 3, 7, 64, 1000, usize::MAX];

/// What came of a file: pieces as text, and rows by section.
#[derive(Debug, Default, PartialEq)]
struct Seen {
    pieces: Vec<String>,
    rows: Vec<(Section, Vec<Vec<u8>>)>,
}

impl Seen {
    fn take(&mut self, piece: Piece<'_>) {
        self.pieces.push(format!("{piece:?}"));
        let Piece::Row(row) = piece else { return };
        if self.rows.last().is_none_or(|(section, _)| *section != row.section) {
            self.rows.push((row.section, vec![]));
        }
        let (_, rows) = self.rows.last_mut().unwrap();
        assert_eq!(row.number as usize, rows.len(), "rows of {} are numbered", row.section);
        rows.push(row.bytes.to_vec());
    }

    /// Rows of a section.
    fn of(&self, section: Section) -> &[Vec<u8>] {
        self.rows.iter().find(|(of, _)| *of == section).map_or(&[], |(_, rows)| rows)
    }
}

/// Whether results are the same; NaN is.
fn is_same(found: Result<(), ReadError>, expected: Result<(), ReadError>) -> bool {
    found == expected || format!("{found:?}") == format!("{expected:?}")
}

/// Pushes a file in chunks.
fn push<const N: usize>(bytes: &[u8], chunk: usize, crc: Crc) -> (Seen, Result<(), ReadError>) {
    let (mut seen, mut reader) = (Seen::default(), PushReader::<N>::with_crc(crc));
    for chunk in bytes.chunks(chunk.min(bytes.len().max(1))) {
        if let Err(error) = reader.push(chunk, |piece| seen.take(piece)) {
            assert!(!reader.is_complete(), "it has failed");
            let again = [reader.push(b"more", |_| panic!("nothing more")), reader.finish()];
            assert!(again.iter().all(|again| is_same(*again, Err(error))), "it stays so: {again:?}");
            return (seen, Err(error));
        }
    }
    let is_complete = reader.is_complete();
    let end = reader.finish();
    assert_eq!(end.is_ok(), is_complete, "{end:?}");
    (seen, end)
}

/// Result of a file pushed in chunks, which must be the same for all.
fn result(bytes: &[u8], crc: Crc) -> Result<(), ReadError> {
    let (_, whole) = push::<4096>(bytes, usize::MAX, crc);
    let (_, small) = push::<4096>(bytes, 7, crc);
    assert!(is_same(whole, small), "chunks make no difference: {whole:?}, {small:?}");
    whole
}

/// The example with a separable basis: L = 1, A = 2.
fn basis() -> Vec<u8> {
    let numbers = [0.5_f32, 2.0].into_iter().chain((0..12_u8).map(|k| f32::from(k) - 4.0));
    let section = [1, 2, 0, 0].into_iter().chain(numbers.flat_map(f32::to_le_bytes));
    let mut file = common::with_section(b"sepb", &section.collect::<Vec<_>>());
    seal_all(&mut file, 5);
    file
}

/// Vectors, BTFs of both models, and a basis, by name.
fn files() -> Vec<(String, Vec<u8>)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/vectors");
    let vectors = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let vectors = vectors.filter(|path| path.extension().is_some_and(|extension| extension == "subsurf"));
    let vectors =
        vectors.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read(path).unwrap()));
    let made = [("nested", btf::nested()), ("factored", btf::factored()), ("basis", basis())];
    let files: Vec<_> = vectors.chain(made.map(|(name, bytes)| (name.to_owned(), bytes))).collect();
    assert!(files.len() > 40, "vectors are at {folder}");
    files
}

/// Vector whose header follows its rows.
const OTHER_ORDER: &str = "other_order.subsurf";

/// Files that both readers take.
fn sound_files() -> impl Iterator<Item = (String, Vec<u8>)> {
    files().into_iter().filter(|(name, bytes)| File::parse(bytes).is_ok() && name != OTHER_ORDER)
}

#[test]
fn rows_are_those_of_the_file_whatever_the_chunks() {
    let mut count = 0;
    for (name, bytes) in sound_files() {
        let (whole, end) = push::<4096>(&bytes, usize::MAX, Crc::Check);
        assert_eq!(end, Ok(()), "{name}");
        for chunk in CHUNKS {
            let (seen, end) = push::<4096>(&bytes, chunk, Crc::Check);
            assert_eq!((&seen, end), (&whole, Ok(())), "{name} in chunks of {chunk}");
        }
        let file = File::parse(&bytes).unwrap();
        let is_read = |section: Section| section.is_critical() || section == Section::SeparableBasis;
        for entry in file.container().entries().filter(|entry| is_read(entry.section)) {
            let (_, section) = file.container().section(entry.section, Crc::Check).unwrap();
            let end = format!("{:?}", Piece::End(entry.section));
            assert!(whole.pieces.contains(&end), "{name}: {} has passed", entry.section);
            let rows = whole.of(entry.section).concat();
            let (before, fill) = match entry.section {
                Section::BssrdfHeader | Section::BtfHeader | Section::KernelHeader | Section::TransferHeader => {
                    (section.len(), 0)
                }
                Section::Materials | Section::CodebookSizes => (section.len(), 0),
                Section::TuckerHeader => (8 + 4 * usize::from(section[2]), 0),
                Section::SeparableBasis => (4, 0),
                Section::Codebook { .. } | Section::Merged | Section::ChromaSlices1 | Section::ChromaSlices2 => (0, 8),
                _ => (0, 0),
            };
            assert_eq!(rows, section[before..section.len() - fill], "{name}: {}", entry.section);
        }
        compare(&name, &whole, file.content());
        count += 1;
    }
    assert!(count > 15, "{count} sound files");
}

/// Shapes of rows and values of a file beside those that the reader of whole files has.
fn compare(name: &str, seen: &Seen, content: Content<'_>) {
    let first = |debug: String| assert_eq!(seen.pieces[0], debug, "{name}");
    let lengths = |section: Section| seen.of(section).iter().map(Vec::len).collect::<Vec<_>>();
    match content {
        Content::Bssrdf(material) => {
            let header = material.header();
            first(format!("{:?}", Piece::Bssrdf(header)));
            if let Some(basis) = material.basis() {
                let size = basis.size();
                assert!(seen.pieces.contains(&format!("{:?}", Piece::Basis(size))), "{name}");
                let factors = vec![12; size.terms * usize::from(header.samples)];
                let expected = [vec![4 * size.gaussians], vec![12 * size.gaussians; size.pairs()], factors].concat();
                assert_eq!(lengths(Section::SeparableBasis), expected, "{name}");
            }
            let [width, height] = [header.width, header.height].map(|side| side as usize);
            let plane = |section, pixel: usize, planes: usize| {
                assert_eq!(lengths(section), vec![pixel * width; planes * height], "{name}: {section}");
                seen.of(section).concat()
            };
            match material.model() {
                BssrdfModel::PerPixel(planes) => {
                    let samples = usize::from(header.samples);
                    assert_eq!(plane(Section::LocalProfiles, 4, 3 * samples), planes.profiles.as_bytes(), "{name}");
                }
                BssrdfModel::BaseMaterials(planes) => {
                    match planes.profiles {
                        Profiles::F32(values) => {
                            assert_eq!(seen.of(Section::BaseProfiles).concat(), values.as_bytes(), "{name}")
                        }
                        Profiles::F16(values) => {
                            assert_eq!(seen.of(Section::HalfProfiles).concat(), values.as_bytes(), "{name}")
                        }
                    }
                    match planes.mixtures {
                        Mixtures::One(indices) => assert_eq!(plane(Section::BaseIndices, 1, 1), indices, "{name}"),
                        Mixtures::OneOfMany(indices) => {
                            assert_eq!(plane(Section::BaseIndices, 2, 1), indices.as_bytes(), "{name}")
                        }
                        Mixtures::Two { ratios, indices } => {
                            assert_eq!(plane(Section::MixtureRatios, 4, 1), ratios.as_bytes(), "{name}");
                            assert_eq!(plane(Section::BaseIndices, 2, 1), indices.as_flattened(), "{name}");
                        }
                        Mixtures::TwoSmall { ratios, indices } => {
                            assert_eq!(plane(Section::SmallRatios, 1, 1), ratios, "{name}");
                            assert_eq!(plane(Section::BaseIndices, 2, 1), indices.as_flattened(), "{name}");
                        }
                        Mixtures::Palette { pairs, codes } => {
                            assert_eq!(seen.of(Section::Pairs).concat(), pairs.as_flattened(), "{name}");
                            assert_eq!(plane(Section::Codes, 2, 1), codes.as_bytes(), "{name}");
                        }
                        Mixtures::Several { ratios, indices, count } => {
                            assert_eq!(plane(Section::MixtureRatios, 4, count), ratios.as_bytes(), "{name}");
                            assert_eq!(plane(Section::BaseIndices, 1, count), indices, "{name}");
                        }
                    }
                }
            }
        }
        Content::NestedBtf(btf) => {
            first(format!("{:?}", Piece::Btf(btf.header())));
            let materials: Vec<_> =
                btf.materials().map(|material| format!("{:?}", Piece::Material(material))).collect();
            assert!(seen.pieces[2..].starts_with(&materials), "{name}");
            let sizes = format!("{:?}", Piece::Codebooks(btf.codebooks().sizes()));
            assert!(seen.pieces.contains(&sizes), "{name}");
            if name != "nested" {
                return;
            }
            // 165 texels of 3 + 10 + 2 bits; 66 rows of P2, then 198 items of 3 + 2 bits; 7 slices.
            let book = |book| lengths(Section::Codebook { book, stage: 0 });
            assert_eq!(book(6), [120, 120, (37 * 15_usize).div_ceil(8)], "{name}");
            assert_eq!(book(2), [vec![3; 66], vec![40, 40, 40, 4]].concat(), "{name}");
            assert_eq!(book(1), [3; 7], "{name}");
            assert_eq!(lengths(Section::ChromaSlices1), [56, 56, 11], "140 items of 7 bits");
            assert_eq!(lengths(Section::Colours), [128, 6], "67 pairs");
        }
        Content::FactoredBtf(btf) => {
            first(format!("{:?}", Piece::Btf(btf.catalog().header())));
            let shape = format!("{:?}", Piece::Tucker(btf.shape()));
            assert!(seen.pieces.contains(&shape), "{name}");
            if name != "factored" {
                return;
            }
            assert_eq!(lengths(Section::TuckerHeader), [8, 20, 20, 8, 12], "ratios, columns twice, views, lights");
            assert_eq!(lengths(Section::Axes), [6; 5], "{name}");
            assert_eq!((lengths(Section::Core), lengths(Section::Codewords)), (vec![128, 128, 44], vec![70]), "{name}");
            assert_eq!(lengths(Section::TexelIndices), [2; 165], "{name}");
        }
        Content::Kernel(kernel) => {
            first(format!("{:?}", Piece::Kernel(kernel.header())));
            let (terms, side) = (kernel.header().terms.into(), kernel.header().side());
            assert_eq!(seen.of(Section::KernelWeights).concat(), kernel.weights().as_bytes(), "{name}");
            assert_eq!(lengths(Section::KernelWeights), vec![12 * side; terms], "{name}");
            assert_eq!(seen.of(Section::KernelTail).concat(), kernel.tail().as_bytes(), "{name}");
        }
        Content::Transfer(transfer) => {
            first(format!("{:?}", Piece::Transfer(transfer.header())));
            let header = transfer.header();
            let of_clusters = |of_each: usize| of_each * usize::from(header.clusters) * usize::from(header.channels);
            assert_eq!(seen.of(Section::VertexCodes).len(), header.vertices as usize, "{name}");
            assert_eq!(seen.of(Section::ClusterMeans).len(), of_clusters(1), "{name}");
            assert_eq!(seen.of(Section::ClusterBases).len(), of_clusters(header.components()), "{name}");
        }
        _ => panic!("{name}: a family without a test"),
    }
}

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

#[test]
fn what_follows_a_file_is_ignored() {
    for (name, mut bytes) in sound_files() {
        let (expected, _) = push::<4096>(&bytes, 64, Crc::Check);
        bytes.extend([0xFF; 100]);
        let (found, end) = push::<4096>(&bytes, 64, Crc::Check);
        assert_eq!((found, end), (expected, Ok(())), "{name}");
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
fn a_buffer_that_is_too_small_says_what_it_takes() {
    let bytes = common::example();
    let (_, end) = push::<27>(&bytes, 7, Crc::Check);
    let section = Section::FileHeader;
    assert_eq!(end, Err(ReadError::BufferTooSmall { section, need_bytes: 124, have_bytes: 27 }));
    // The header, 40 bytes or more as versions have it, is the longest row of so small a patch.
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
fn a_reader_of_a_patch_of_229_pixels_is_small() {
    // Section table of five sections, and a row of ratios.
    const N: usize = 28 + 5 * 24 + 4 * 229;
    assert_eq!(N, 1_064, "as the documentation says");
    assert!(size_of::<PushReader<N>>() < N + 512, "{} bytes", size_of::<PushReader<N>>());
    const { assert!(size_of::<PushReader<N>>() <= 8_192) };
    println!("{} bytes", size_of::<PushReader<N>>());
}

#[test]
fn rows_before_what_they_depend_on_are_refused() {
    // Sections of sound files in another order, which the reader of whole files takes.
    let swapped = |bytes: &[u8], a: Section, b: Section| {
        let file = File::parse(bytes).unwrap();
        let sections = file.container().entries().map(|entry| entry.section);
        let of = |section: Section| {
            let section = if section == a {
                b
            } else if section == b {
                a
            } else {
                section
            };
            (section.kind(), file.container().section(section, Crc::Check).unwrap().1.to_vec())
        };
        let sections: Vec<_> = sections.map(of).collect();
        let bytes = container(&sections.iter().map(|(kind, bytes)| (kind, bytes.clone())).collect::<Vec<_>>());
        assert!(File::parse(&bytes).is_ok(), "{a} and {b} in another order");
        push::<4096>(&bytes, 64, Crc::Check).1
    };
    let (nested, factored, example) = (btf::nested(), btf::factored(), common::example());
    for (bytes, section, needs) in [
        (&example, Section::BaseProfiles, Section::BssrdfHeader),
        (&nested, Section::Materials, Section::BtfHeader),
        (&nested, Section::CodebookSizes, Section::Materials),
        (&nested, Section::Codebook { book: 6, stage: 0 }, Section::CodebookSizes),
        (&factored, Section::TuckerHeader, Section::Materials),
        (&factored, Section::Axes, Section::TuckerHeader),
    ] {
        assert_eq!(swapped(bytes, section, needs), Err(ReadError::OutOfOrder { section, needs }));
    }
    assert_eq!(swapped(&example, Section::MixtureRatios, Section::BaseIndices), Ok(()), "these are as they like");
    let (_, vector) = files().into_iter().find(|(name, _)| name == OTHER_ORDER).expect("the vector");
    let (section, needs) = (Section::BaseIndices, Section::BssrdfHeader);
    assert!(File::parse(&vector).is_ok(), "the reader of whole files takes any order");
    assert_eq!(push::<4096>(&vector, 64, Crc::Check).1, Err(ReadError::OutOfOrder { section, needs }));
}
