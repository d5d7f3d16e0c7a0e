//! The reader of pushed bytes against the reader of whole files: the same rows, whatever the chunks.

use crate::common::btf::factored;
use crate::common::push::{CHUNKS, Seen, push, sound_files};
use crate::common::rebuilt;
use subsurf_decoder::bssrdf::{BssrdfModel, Mixtures, Profiles};
use subsurf_decoder::container::Crc;
use subsurf_decoder::push::{Piece, PushReader};
use subsurf_decoder::{Content, File, Section};

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
    // Of a node, of a light.
    for (section, bytes) in
        [(Section::BaseProfiles, 12), (Section::HalfProfiles, 6), (Section::KernelTail, 12), (Section::Lights, 12)]
    {
        assert!(lengths(section).iter().all(|length| *length == bytes), "{name}: {section}");
    }
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
            let (shape, grid) = (btf.shape(), btf.catalog().grid());
            let views = vec![grid.view_nodes(); shape.view_axes.into()];
            let lights = vec![grid.light_nodes(); shape.light_axes.into()];
            assert_eq!(lengths(Section::Axes), [views, lights].concat(), "{name}");
            if name != "factored" {
                return;
            }
            assert_eq!(lengths(Section::TuckerHeader), [8, 20, 20, 8, 12], "ratios, columns twice, views, lights");
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
            let of_clusters = |of_each: usize| of_each * usize::from(header.clusters);
            assert_eq!(
                lengths(Section::LightAxes).len(),
                usize::from(header.channels) * usize::from(header.lights),
                "{name}"
            );
            assert_eq!(seen.of(Section::VertexCodes).len(), header.vertices as usize, "{name}");
            assert_eq!(seen.of(Section::ClusterMeans).len(), of_clusters(1), "{name}");
            assert_eq!(seen.of(Section::ClusterBases).len(), of_clusters(header.components()), "{name}");
        }
        _ => panic!("{name}: a family without a test"),
    }
}

#[test]
fn sections_that_are_not_read_take_no_buffer() {
    for (name, bytes) in sound_files() {
        let (expected, end) = push::<2048>(&bytes, 64, Crc::Check);
        assert_eq!(end, Ok(()), "{name}");
        for number in [0, 1, usize::from(bytes[12])] {
            let longer = rebuilt(&bytes, |sections| sections.insert(number, (*b"fill", vec![0xFF; 3_000])));
            for chunk in [7, 1000, usize::MAX] {
                let (found, end) = push::<2048>(&longer, chunk, Crc::Check);
                assert_eq!((&found, end), (&expected, Ok(())), "{name}, section {number}, chunks of {chunk}");
            }
        }
    }
}

#[test]
fn tints_that_the_sizes_leave_out_are_passed_over() {
    let (_, bytes) = sound_files().find(|(name, _)| name == "nested_display.subsurf").expect("the vector");
    let expected = push::<2048>(&bytes, 64, Crc::Check);
    let longer = rebuilt(&bytes, |sections| sections.push((*b"TINT", vec![0xFF; 3_000])));
    assert!(File::parse(&longer).is_ok(), "the reader of whole files does not look at it");
    assert_eq!(push::<2048>(&longer, 64, Crc::Check), expected);
}

#[test]
fn a_section_without_bytes_has_no_rows() {
    let bytes = rebuilt(&factored(), |sections| {
        for (_, content) in sections.iter_mut().filter(|(kind, _)| [*b"CORE", *b"WORD"].contains(kind)) {
            content.clear();
        }
    });
    let (seen, end) = push::<4096>(&bytes, 64, Crc::Check);
    assert_eq!(end, Ok(()));
    for section in [Section::Core, Section::Codewords] {
        assert_eq!(seen.of(section), &[] as &[Vec<u8>], "{section}");
        assert!(seen.pieces.contains(&format!("{:?}", Piece::End(section))), "{section} has passed");
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

#[test]
fn a_reader_of_a_patch_of_229_pixels_is_small() {
    // Section table of five sections, and a row of ratios.
    const N: usize = 28 + 5 * 24 + 4 * 229;
    assert_eq!(N, 1_064, "as the documentation says");
    assert!(size_of::<PushReader<N>>() < N + 512, "{} bytes", size_of::<PushReader<N>>());
    const { assert!(size_of::<PushReader<N>>() <= 8_192) };
    println!("{} bytes", size_of::<PushReader<N>>());
}
