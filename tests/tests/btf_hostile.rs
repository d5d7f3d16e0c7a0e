//! Hostile BTF files: every outcome is an error or a bounded value.

use proptest::prelude::*;
use subsurf_decoder::btf::nested::layout::Scales;
use subsurf_decoder::btf::{ColourEncoding, Grid};
use subsurf_decoder::container::{Crc, ENTRY_BYTES, FILE_HEADER_BYTES, crc32};
use subsurf_decoder::{Bssrdf, Content, FactoredBtf, Family, File, NestedBtf, ReadError, Section};
use subsurf_encoder::btf::nested::Database;
use subsurf_encoder::synthetic::NestedShape;

/// All kinds of sections in a few hundred bytes.
fn shape() -> NestedShape {
    let grid = Grid { n_alpha: 3, n_beta: 2, n_theta: 2, n_phi: 3, alpha_max: 1.4, cos_light_min: 0.1, ..Grid::PAPER };
    NestedShape {
        grid,
        materials: vec![(3, 2, 2), (1, 1, 1)],
        stages: 2,
        luma: [3, 5, 3, 5],
        chroma: [5, 3, 3, 3],
        tints: 3,
        ..NestedShape::small()
    }
}

/// The same with every choice made otherwise.
fn other_shape() -> NestedShape {
    NestedShape {
        tone: ColourEncoding::LogLuv { toe: 0.01, peak: 50.0 },
        is_relative: true,
        scale_bits: 10,
        stages: 1,
        tints: 0,
        ..shape()
    }
}

/// Recomputes every CRC of a file whose section table leads somewhere.
fn seal(file: &mut [u8]) {
    let read = |file: &[u8], at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap());
    let count = u32::from_le_bytes(file[12..16].try_into().unwrap()) as usize;
    let table_end = FILE_HEADER_BYTES + count.min(64) * ENTRY_BYTES;
    if table_end + 4 > file.len() {
        return;
    }
    for entry in (FILE_HEADER_BYTES..table_end).step_by(ENTRY_BYTES) {
        let [start, length] = [8, 16].map(|at| usize::try_from(read(file, entry + at)).ok());
        let end = start.zip(length).and_then(|(start, length)| start.checked_add(length));
        let bytes = start.zip(end).and_then(|(start, end)| file.get(start..end));
        let crc = crc32(bytes.unwrap_or(&[]));
        file[entry + 4..entry + 8].copy_from_slice(&crc.to_le_bytes());
    }
    let crc = crc32(&file[..table_end]);
    file[table_end..table_end + 4].copy_from_slice(&crc.to_le_bytes());
}

/// Uses everything a parsed file offers and checks the bounds that hold for any file.
fn exercise(btf: &NestedBtf<'_>) {
    let directions = [
        [0.0, 0.0, 1.0],
        [0.6, 0.0, 0.8],
        [-0.48, 0.64, 0.6],
        [0.0, -1.0, 0.0],
        [0.0, 0.0, -1.0],
        [0.0; 3],
        [f32::NAN; 3],
        [f32::INFINITY, f32::NEG_INFINITY, 1.0],
    ];
    let ends = [[0.0, 0.0], [1.0, 1.0], [0.3, 0.8], [f32::NAN, 7.0]];
    let materials = btf.materials().count();
    let places = [(0, 0, [1, 1]), (materials.saturating_sub(1), 0, [i32::MIN, i32::MAX]), (0, 1, [0, 0])];
    for (material, level, at) in places {
        let Some(texel) = btf.texel(material, level, at) else {
            assert!(level > 0, "every material has a first level");
            continue;
        };
        for view in directions {
            for light in directions {
                let value = btf.eval(texel, light, view);
                assert!(value.iter().all(|value| value.is_finite() && *value >= 0.0), "{light:?} {view:?}: {value:?}");
            }
            let sampler = btf.sampler(texel, &btf.grid().view(view));
            for random in ends {
                let sample = sampler.sample(random);
                let [x, y, z] = sample.light;
                assert!(sample.pdf.is_finite() && sample.pdf > 0.0, "{view:?} {random:?}: {sample:?}");
                assert!((x * x + y * y + z * z - 1.0).abs() < 1e-3 && z >= 0.0, "{view:?}: {sample:?}");
            }
            for light in directions {
                let pdf = sampler.pdf(light);
                assert!(pdf.is_finite() && pdf >= 0.0, "{light:?} {view:?}: {pdf}");
            }
        }
        let albedo = btf.albedo(texel, [0.6, 0.0, 0.8]);
        assert!(albedo.iter().all(|albedo| albedo.is_finite() && *albedo >= 0.0), "{albedo:?}");
    }
    assert!(btf.materials().all(|material| material.name().len() <= 24), "names are part of a material");
}

#[test]
fn cut_at_every_length() {
    for shape in [shape(), other_shape()] {
        let file = shape.database(1).to_bytes();
        exercise(&NestedBtf::parse(&file).unwrap());
        for length in 0..file.len() {
            let error = NestedBtf::parse(&file[..length]).unwrap_err();
            assert!(matches!(error, ReadError::Truncated { .. }), "{length}: {error:?}");
        }
    }
}

#[test]
fn every_bit_of_every_byte_flipped() {
    for shape in [shape(), other_shape()] {
        let file = shape.database(2).to_bytes();
        for (at, bit) in (0..file.len()).flat_map(|at| (0..8).map(move |bit| (at, bit))) {
            let mut bad = file.clone();
            bad[at] ^= 1 << bit;
            // Fill between sections is no part of any.
            let is_fill = NestedBtf::parse(&bad).is_ok();
            assert!(!is_fill || file[at] == 0, "a CRC covers byte {at}");
            if let Ok(btf) = NestedBtf::parse_with(&bad, Crc::Skip) {
                exercise(&btf);
            }
            // The same damage by someone who recomputes the CRCs.
            seal(&mut bad);
            if let Ok(btf) = NestedBtf::parse(&bad) {
                exercise(&btf);
            }
        }
    }
}

/// Changes a database after it was made.
fn changed(shape: &NestedShape, change: impl Fn(&mut Database)) -> Vec<u8> {
    let mut database = shape.database(3);
    change(&mut database);
    database.to_bytes()
}

#[test]
fn the_largest_and_smallest_scales_are_bounded() {
    // 2^24 and 2^−24, in all four codebooks, and nothing but zeros or the largest values below them.
    for (shape, offset) in
        [shape(), other_shape()].into_iter().flat_map(|shape| [-1536, 1536].map(|offset| (shape.clone(), offset)))
    {
        for byte in [0, 1, 127, 128, 255] {
            let file = changed(&shape, |database| {
                for chain in &mut database.stages {
                    chain.scales = [Scales { bits: 0, step: 0, offset }; 4];
                    for items in [&mut chain.texels, &mut chain.p4, &mut chain.p3, &mut chain.p2] {
                        items.iter_mut().for_each(|item| item.code = 0);
                    }
                    // Heights as well.
                    chain.p1.fill(byte);
                }
                database.chroma.first = [16.0, -16.0];
                database.chroma.step = [16.0; 2];
            });
            exercise(&NestedBtf::parse(&file).unwrap());
        }
    }
}

#[test]
fn what_is_out_of_range_is_refused_for_what_it_is() {
    let bytes_of = |file: &[u8], section: Section| {
        let container = subsurf_decoder::container::Container::parse(file).unwrap();
        let (entry, bytes) = container.section(section, Crc::Check).unwrap();
        (usize::try_from(entry.offset).unwrap(), bytes.len())
    };
    let refused = |section: Section, at: usize, bytes: &[u8]| {
        let mut file = shape().database(4).to_bytes();
        let (start, _) = bytes_of(&file, section);
        file[start + at..start + at + bytes.len()].copy_from_slice(bytes);
        seal(&mut file);
        (NestedBtf::parse(&file).unwrap_err(), (start + at) as u64)
    };
    let header = |at, value: u8| refused(Section::BtfHeader, at, &[value]);
    for (at, value) in [(0, 3), (1, 0), (2, 0), (4, 1), (4, 65), (5, 1), (6, 0), (7, 0), (7, 255)] {
        let (error, offset) = header(at, value);
        let expected = ReadError::BadField { section: Section::BtfHeader, offset, value: value.into() };
        assert_eq!(error, expected, "byte {at}");
    }
    for (at, value) in [(8, 1.6_f32), (12, 1.1), (16, 0.0), (20, 1.0), (24, f32::NAN), (20, -0.1)] {
        let (error, place) = refused(Section::BtfHeader, at, &value.to_le_bytes());
        let ReadError::BadNumber { section, offset, .. } = error else { panic!("{at}: {error:?}") };
        assert_eq!((section, offset), (Section::BtfHeader, place));
    }
    for at in [24, 26, 28] {
        let (error, place) = refused(Section::Materials, at, &[0, 0]);
        assert_eq!(error, ReadError::BadField { section: Section::Materials, offset: place, value: 0 });
    }
    // More bits, entries that are not there, scales above 2^24, a signed first stage.
    for (at, bytes) in [(44, &[17, 0][..]), (44, &[0, 7]), (0, &[0; 4]), (40, &[0xFF; 4]), (76, &[1]), (46, &[1, 6])] {
        let (error, place) = refused(Section::CodebookSizes, at, bytes);
        let ReadError::BadField { section, offset, .. } = error else { panic!("{at}: {error:?}") };
        assert_eq!(section, Section::CodebookSizes, "byte {at}");
        assert!(place.abs_diff(offset) <= 2, "byte {at}: {offset} is not {place}");
    }
    // Five rows are counted in three bits, three in two.
    let tables = [
        (Section::Codebook { book: 4, stage: 0 }, 5),
        (Section::Codebook { book: 3, stage: 0 }, 5),
        (Section::Codebook { book: 3, stage: 1 }, 3),
        (Section::Merged, 3),
        (Section::ChromaSlices2, 3),
        (Section::ChromaSlices1, 3),
    ];
    for (section, len) in tables {
        let (error, place) = refused(section, 0, &[0xFF]);
        let index = if len == 5 { 7 } else { 3 };
        assert_eq!(error, ReadError::IndexOutOfRange { section, offset: place, index, len }, "{section}");
    }
    // Codes of P2 stand before its indices: three rows of three.
    let (error, place) = refused(Section::Codebook { book: 2, stage: 0 }, 9, &[0xFF]);
    let section = Section::Codebook { book: 2, stage: 0 };
    assert_eq!(error, ReadError::IndexOutOfRange { section, offset: place, index: 7, len: 5 });
    let (error, _) = refused(Section::Codebook { book: 6, stage: 0 }, 0, &[0xFF]);
    assert!(matches!(error, ReadError::IndexOutOfRange { index: 3, len: 3, .. }), "{error:?}");
    // Other numbers ask for other sizes.
    for (section, at, bytes) in [
        (Section::BtfHeader, 5, &[3][..]),
        (Section::Materials, 24, &[4, 0]),
        (Section::CodebookSizes, 12, &[9, 0, 0, 0]),
        (Section::CodebookSizes, 40 + 32, &[9, 0, 0, 0]),
    ] {
        let (error, _) = refused(section, at, bytes);
        assert!(matches!(error, ReadError::WrongSize { .. }), "{section} byte {at}: {error:?}");
    }
}

#[test]
fn sections_that_are_needed_are_missed() {
    let database = shape().database(5);
    let file = database.to_bytes();
    let count = usize::from(file[12]);
    for entry in (0..count).map(|k| FILE_HEADER_BYTES + k * ENTRY_BYTES) {
        let mut bad = file.clone();
        let section = Section::from_kind(bad[entry..entry + 4].try_into().unwrap());
        bad[entry..entry + 4].copy_from_slice(b"xxxx");
        seal(&mut bad);
        assert_eq!(NestedBtf::parse(&bad).unwrap_err(), ReadError::Missing { section });
    }
}

#[test]
fn files_of_another_family_are_refused_as_such() {
    let nested = shape().database(5).to_bytes();
    let bssrdf = subsurf_tests::format_example();
    let other = |found, expected| ReadError::OtherFamily { found, expected };
    let error = Bssrdf::parse(&nested).unwrap_err();
    assert_eq!(error, other(Family::NestedBtf, Family::Bssrdf));
    assert_eq!(error.to_string(), "a nested BTF, not a BSSRDF");
    assert_eq!(NestedBtf::parse(&bssrdf).unwrap_err(), other(Family::Bssrdf, Family::NestedBtf));
    assert_eq!(FactoredBtf::parse(&nested).unwrap_err(), other(Family::NestedBtf, Family::FactoredBtf));
    let content = File::parse(&nested).unwrap().content();
    assert!(matches!(content, Content::NestedBtf(_)), "the front door finds out");
}

proptest! {
    #[test]
    fn any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..1200)) {
        prop_assert!(NestedBtf::parse(&bytes).is_err());
    }

    #[test]
    fn any_damage_with_valid_crcs(
        is_other in any::<bool>(),
        changes in proptest::collection::vec((8_usize..4096, any::<u8>()), 1..8),
    ) {
        let mut file = if is_other { other_shape() } else { shape() }.database(6).to_bytes();
        let length = file.len();
        for (at, value) in changes {
            file[at % (length - 8) + 8] = value;
        }
        seal(&mut file);
        if let Ok(btf) = NestedBtf::parse(&file) {
            exercise(&btf);
        }
    }

    #[test]
    fn any_contents_behind_a_sound_start(
        is_other in any::<bool>(),
        bytes in proptest::collection::vec(any::<u8>(), 4096),
    ) {
        // Headers as they are, and anything in all tables. Every index is one of as many entries as it can tell apart.
        let shape = if is_other { other_shape() } else { NestedShape { tints: 4, ..shape() } };
        let shape = NestedShape { luma: [4, 8, 4, 8], chroma: [8, 4, 4, 4], ..shape };
        let mut file = shape.database(7).to_bytes();
        let container = subsurf_decoder::container::Container::parse(&file).unwrap();
        let (entry, books) = container.section(Section::CodebookSizes, Crc::Check).unwrap();
        let start = usize::try_from(entry.offset).unwrap() + books.len();
        for (byte, random) in file[start..].iter_mut().zip(bytes) {
            *byte = random;
        }
        seal(&mut file);
        exercise(&NestedBtf::parse(&file).unwrap());
    }
}
