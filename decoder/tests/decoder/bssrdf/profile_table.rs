//! Profiles expanded to the distances of a window against the evaluation of a file.

use crate::common::container;
use subsurf_decoder::bssrdf::layout::{MODEL_2BMPP, MODEL_PER_PIXEL};
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, BssrdfModel, Coding, Mixture, Mixtures, ProfileTable};
use subsurf_decoder::container::bytes::F32Le;
use subsurf_decoder::push::{Piece, PushReader};
use subsurf_decoder::{Bssrdf, Content, File, Section};

const R: u16 = 6;
const PLACES: usize = 28;
const MATERIALS: u8 = 3;

/// A patch of 5 × 4 pixels of three base materials with values from `least` to `most`.
fn patch(least: f32, most: f32) -> Vec<u8> {
    let header = BssrdfHeader {
        model: MODEL_2BMPP,
        coding: Coding::Exact,
        addressing: Addressing::Clamp,
        width: 5,
        height: 4,
        window_radius: R,
        samples: 7,
        base_materials: MATERIALS.into(),
        pitch_mm: 0.3,
        // Some of the window's corner is beyond it.
        r_max_mm: 2.0,
        eta: 1.4,
    };
    let mut state = 1_u32;
    let mut draw = || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f32::from(u16::try_from(state >> 16).unwrap()) / 65_535.0
    };
    let mut floats = |count: usize, least: f32, most: f32| -> Vec<u8> {
        (0..count).flat_map(|_| (least + (most - least) * draw()).to_le_bytes()).collect()
    };
    let (profiles, ratios) = (floats(7 * 3 * usize::from(MATERIALS), least, most), floats(20, 0.0, 1.0));
    let indices = (0..40_u8).map(|k| (k / 2 + k % 2) % MATERIALS).collect();
    let header = header.to_bytes().to_vec();
    container(&[(b"BSSR", header), (b"PROF", profiles), (b"MIXR", ratios), (b"BIDX", indices)])
}

/// Mixture of a pixel within the patch.
fn mixtures<'a>(material: &Bssrdf<'a>) -> Mixtures<'a> {
    let BssrdfModel::BaseMaterials(planes) = material.model() else { panic!("base materials") };
    planes.mixtures
}

/// Largest relative difference of a table's Rd from [`Bssrdf::rd`], over all pairs of pixels; both are 0 for the same pairs.
fn largest_difference<const N: usize>(material: &Bssrdf<'_>, table: &ProfileTable<N>) -> f64 {
    let [width, height] = [material.header().width, material.header().height].map(u32::cast_signed);
    let pixels = || (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
    let count = usize::try_from(width * height).unwrap();
    let mixture = |[x, y]: [i32; 2]| mixtures(material).at(usize::try_from(y * width + x).unwrap(), count);
    let (mut largest, mut lit) = (0.0_f64, 0);
    for (a, b) in pixels().flat_map(|a| pixels().map(move |b| (a, b))) {
        let [dx, dy] = [a[0] - b[0], a[1] - b[1]];
        let (expected, found) = (material.rd(a, b), table.rd(&mixture(a), &mixture(b), dx, dy));
        for (expected, found) in expected.into_iter().zip(found) {
            assert_eq!(expected == 0.0, found == 0.0, "{a:?} {b:?}: {found}, not {expected}");
            if expected > 0.0 {
                largest = largest.max((f64::from(found) / f64::from(expected) - 1.0).abs());
                lit += 1;
            }
        }
    }
    assert!(lit > 0, "some pairs are lit");
    largest
}

#[test]
fn rd_is_that_of_the_file_within_the_stated_errors() {
    for (least, most, bound) in [(-8.0, 2.0, 2e-6), (-87.0, 87.0, 2e-5)] {
        let bytes = patch(least, most);
        let material = Bssrdf::parse(&bytes).unwrap();
        let mut table = ProfileTable::<{ 3 * PLACES }>::new();
        assert!(table.expand(&material), "there is room");
        let difference = largest_difference(&material, &table);
        println!("{least} to {most}: {difference:e}");
        assert!(difference < bound, "{least} to {most}: {difference:e}");
    }
}

#[test]
fn vectors_have_the_same_rd() {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/vectors");
    let mut count = 0;
    for entry in std::fs::read_dir(folder).unwrap() {
        let bytes = std::fs::read(entry.unwrap().path()).unwrap();
        let Ok(Content::Bssrdf(material)) = File::parse(&bytes).map(|file| file.content()) else { continue };
        let mut table = ProfileTable::<8192>::new();
        let is_mixed = material.header().model != MODEL_PER_PIXEL;
        assert_eq!(table.expand(&material), is_mixed, "{:?}", material.header());
        if is_mixed {
            let difference = largest_difference(&material, &table);
            assert!(difference < 2e-6, "{difference:e}");
            count += 1;
        }
    }
    assert!(count > 10, "{count} vectors");
}

#[test]
fn nodes_that_are_pushed_make_the_same_table() {
    let bytes = patch(-8.0, 2.0);
    let material = Bssrdf::parse(&bytes).unwrap();
    let (mut expected, mut table) = (ProfileTable::<84>::new(), ProfileTable::<84>::new());
    assert!(expected.expand(&material), "there is room");
    let mut reader = PushReader::<256>::new();
    let pushed = reader.push(&bytes, |piece| match piece {
        Piece::Bssrdf(header) => assert!(table.begin(header), "there is room"),
        Piece::Row(row) if row.section == Section::BaseProfiles => {
            let node = F32Le::new(row.bytes);
            table.push([0, 1, 2].map(|c| node.get(c).unwrap()));
        }
        _ => {}
    });
    assert_eq!(pushed, Ok(()));
    assert_eq!(format!("{table:?}"), format!("{expected:?}"));
}

#[test]
fn materials_without_a_share_may_be_missing() {
    let bytes = patch(-8.0, 2.0);
    let material = Bssrdf::parse(&bytes).unwrap();
    let mut table = ProfileTable::<84>::new();
    assert!(table.begin(material.header()), "there is room");
    for _ in 0..material.header().samples {
        table.push([0.0; 3]);
    }
    // The first material is there, others are not.
    for (t, due) in [(1.0, [1.0; 3]), (0.5, [0.0; 3])] {
        let pixel = Mixture { bases: [0, 1, 0, 0, 0], ratios: [t, 1.0 - t, 0.0, 0.0, 0.0] };
        assert_eq!(table.rd(&pixel, &pixel, 0, 0), due, "{t} of the first");
    }
}

#[test]
fn a_table_that_is_too_small_has_nothing() {
    let bytes = patch(-8.0, 2.0);
    let material = Bssrdf::parse(&bytes).unwrap();
    let colours = 3 * PLACES;
    assert_eq!(ProfileTable::<0>::colours(material.header()), Some(colours));
    let pixel = mixtures(&material).at(0, 20);
    let mut small = ProfileTable::<83>::new();
    assert!(!small.expand(&material), "one too few");
    assert_eq!(small.rd(&pixel, &pixel, 0, 0), [0.0; 3]);
    let mut table = ProfileTable::<84>::new();
    assert!(table.begin(material.header()), "as many as it takes");
    assert_eq!(table.rd(&pixel, &pixel, 0, 0), [0.0; 3], "no node has come");
    assert!(table.expand(&material) && table.rd(&pixel, &pixel, 0, 0) > [0.0; 3], "all have");
    // More nodes than there are, and pixels further apart than the window reaches.
    table.push([87.0; 3]);
    for [dx, dy] in [[7, 0], [0, -7], [i32::MIN, i32::MAX]] {
        assert_eq!(table.rd(&pixel, &pixel, dx, dy), [0.0; 3], "{dx}, {dy}");
    }
    let place = |dx, dy| table.rd(&pixel, &pixel, dx, dy);
    assert_eq!([place(2, -3), place(-3, 2), place(-2, -3)], [place(3, 2); 3], "distances alone count");
    assert!(!small.begin(&BssrdfHeader { model: MODEL_PER_PIXEL, ..*material.header() }), "no base materials");
}
