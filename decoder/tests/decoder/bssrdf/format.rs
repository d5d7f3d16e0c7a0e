//! The reader against the words of `FORMAT.md`.

use crate::common::{BIDX, MIXR, MODEL, PITCH, PROF, PROFILES, SAMPLES, WIDTH, crc32, example, seal};
use subsurf_decoder::bssrdf::{Addressing, BssrdfModel, Mixtures, Profiles};
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Bssrdf, ReadError, Section};

fn refused(change: impl Fn(&mut Vec<u8>)) -> ReadError {
    let mut file = example();
    change(&mut file);
    seal(&mut file);
    Bssrdf::parse(&file).unwrap_err()
}

fn assert_close(found: [f32; 3], expected: [f64; 3]) {
    for (found, expected) in found.into_iter().zip(expected) {
        let error = (f64::from(found) - expected).abs();
        assert!(error <= 1e-6 * expected.abs(), "{found} is not {expected}");
    }
}

#[test]
fn crc_is_the_one_of_the_specification() {
    assert_eq!(crc32(b"123456789"), 0xCBF4_3926);
    assert_eq!(subsurf_decoder::container::crc32(b"123456789"), 0xCBF4_3926);
}

#[test]
fn reads_the_example() {
    let file = example();
    let material = Bssrdf::parse(&file).unwrap();
    let header = material.header();
    assert_eq!((header.width, header.height), (2, 1));
    assert_eq!((header.window_radius, header.samples), (1, 2));
    assert_eq!(header.base_materials, 2);
    assert_eq!(header.addressing, Addressing::Clamp);
    assert_eq!((header.pitch_mm, header.r_max_mm, header.eta), (0.5, 1.0, 1.5));
    let BssrdfModel::BaseMaterials(planes) = material.model() else {
        panic!("model 2 is two base materials");
    };
    let (Profiles::F32(profiles), Mixtures::Two { ratios, indices }) = (planes.profiles, planes.mixtures) else {
        panic!("exact 2-BMPP");
    };
    assert!(profiles.iter().eq(PROFILES), "profiles in file order");
    assert!(ratios.iter().eq([1.0, 0.25]), "ratios in file order");
    assert_eq!(indices, [[0, 1], [1, 0]]);
    assert_eq!(profiles.as_bytes(), &file[PROF..MIXR]);
}

#[test]
fn evaluates_equations_1_to_4() {
    let file = example();
    let material = Bssrdf::parse(&file).unwrap();
    // Pixel 0 is material 0; pixel 1 is 0.25 of material 1 and 0.75 of material 0.
    let p0 = [-1.0, -2.0, -3.0, -2.0, -4.0, -6.0];
    let p1 = [-1.5, -2.0, -2.5, -2.75, -4.25, -5.75];
    let at = |p: [f64; 6], w: f64, c: usize| (1.0 - w) * p[c] + w * p[3 + c];
    let rd = |a, b, w| [0, 1, 2].map(|c| (0.5 * (at(a, w, c) + at(b, w, c))).exp());

    assert_close(material.rd([0, 0], [0, 0]), rd(p0, p0, 0.0));
    // Neighbours are 0.5 mm apart: half way between node 0 and node 1 at 1 mm.
    assert_close(material.rd([0, 0], [1, 0]), rd(p0, p1, 0.5));
    assert_eq!(material.rd([0, 0], [1, 0]), material.rd([1, 0], [0, 0]));
    // Clamp: pixel (2, 0) is pixel (1, 0), at its own distance; the diagonal is √½ mm away.
    assert_close(material.rd([2, 0], [1, 0]), rd(p1, p1, 0.5));
    assert_close(material.rd([2, 1], [1, 0]), rd(p1, p1, 0.5_f64.sqrt()));
    // Beyond the last node there is nothing, in particular not the next material.
    assert_eq!(material.profile([0, 0]).node(2), [0.0; 3]);
    // Outside the window.
    assert_eq!(material.rd([0, 0], [2, 0]), [0.0; 3]);

    // Window of pixel 0 in clamp: columns −1 and 0 are pixel 0, column 1 is pixel 1.
    let mut albedo = [0.0; 3];
    for dy in -1_i32..=1 {
        for (dx, other) in [(-1_i32, p0), (0, p0), (1, p1)] {
            let r = f64::from(dx * dx + dy * dy).sqrt() * 0.5;
            let term = rd(p0, other, r);
            for c in 0..3 {
                albedo[c] += term[c] * 0.25;
            }
        }
    }
    assert_close(material.albedo([0, 0]), albedo);
}

#[test]
fn distances_beyond_r_max_do_not_scatter() {
    let mut file = example();
    file[PITCH..PITCH + 4].copy_from_slice(&1.0_f32.to_le_bytes());
    seal(&mut file);
    let material = Bssrdf::parse(&file).unwrap();
    assert!(material.rd([0, 0], [1, 0])[0] > 0.0, "r = r_max belongs to the profile");
    assert_eq!(material.rd([0, 0], [1, 1]), [0.0; 3]);
    assert!(material.knot(f32::NAN).is_none(), "NaN is no distance");
}

#[test]
fn refuses_what_the_specification_forbids() {
    let bad_field = |at, value| ReadError::BadField { section: Section::BssrdfHeader, offset: at, value };
    assert_eq!(refused(|f| f[MODEL] = 4), bad_field(124, 4));
    assert_eq!(refused(|f| f[MODEL + 1] = 2), bad_field(125, 2));
    assert_eq!(refused(|f| f[MODEL + 2] = 3), bad_field(126, 3));
    assert_eq!(refused(|f| f[MODEL + 3] = 3), bad_field(127, 3));
    // Another coding or model asks for other sections.
    assert_eq!(refused(|f| f[MODEL + 3] = 1), ReadError::Missing { section: Section::SmallRatios });
    assert_eq!(refused(|f| f[MODEL + 3] = 2), ReadError::Missing { section: Section::Pairs });
    assert_eq!(
        refused(|f| f[MODEL] = 3),
        ReadError::WrongSize { section: Section::MixtureRatios, need_bytes: 24, have_bytes: 8 }
    );
    assert_eq!(refused(|f| f[WIDTH] = 0), bad_field(128, 0));
    assert_eq!(refused(|f| f[SAMPLES] = 1), bad_field(138, 1));
    assert_eq!(
        refused(|f| f[WIDTH] = 3),
        ReadError::WrongSize { section: Section::MixtureRatios, need_bytes: 12, have_bytes: 8 }
    );
    assert_eq!(
        refused(|f| f[BIDX + 2] = 7),
        ReadError::IndexOutOfRange { section: Section::BaseIndices, offset: 214, index: 7, len: 2 }
    );
    for ratio in [-0.0_f32, -1e-9, 1.000_001, f32::NAN, f32::INFINITY] {
        let error = refused(|f| f[MIXR + 4..MIXR + 8].copy_from_slice(&ratio.to_le_bytes()));
        let ReadError::BadNumber { section, offset, .. } = error else {
            panic!("{ratio}: {error:?}");
        };
        assert_eq!((section, offset), (Section::MixtureRatios, 208));
    }
    for log in [87.01_f32, -88.0, f32::NAN, f32::NEG_INFINITY] {
        let error = refused(|f| f[PROF..PROF + 4].copy_from_slice(&log.to_le_bytes()));
        let ReadError::BadNumber { section, offset, .. } = error else {
            panic!("{log}: {error:?}");
        };
        assert_eq!((section, offset), (Section::BaseProfiles, 156));
    }
    for pitch in [0.0_f32, -1.0, f32::NAN, f32::INFINITY] {
        let error = refused(|f| f[PITCH..PITCH + 4].copy_from_slice(&pitch.to_le_bytes()));
        assert!(matches!(error, ReadError::BadNumber { offset: 144, .. }), "{pitch}: {error:?}");
    }
}

#[test]
fn refuses_broken_containers() {
    assert_eq!(refused(|f| f[0] = 0), ReadError::NotSubsurf);
    assert_eq!(refused(|f| f[8] = 2), ReadError::NewerVersion { major: 2, minor: 0 });
    assert_eq!(refused(|f| f[12] = 65), ReadError::SectionCount { count: 65, limit: 64 });
    // PROF moved into BSSR.
    assert_eq!(
        refused(|f| f[24 + 24 + 8] = 0x80),
        ReadError::Overlap { section: Section::BaseProfiles, offset: 128, earliest: 156 }
    );
    // MIXR named PROF.
    assert_eq!(refused(|f| f.copy_within(48..52, 72)), ReadError::Duplicate { section: Section::BaseProfiles });
    // MIXR named something else: skipped, and missed.
    assert_eq!(refused(|f| f[72] = b'x'), ReadError::Missing { section: Section::MixtureRatios });
    // A length that would overflow.
    assert_eq!(
        refused(|f| f[24 + 72 + 16..24 + 72 + 24].fill(0xFF)),
        ReadError::Truncated { section: Section::BaseIndices, need_bytes: u64::MAX, have_bytes: 216 }
    );
}

#[test]
fn accepts_later_minor_versions_and_trailing_bytes() {
    let mut file = example();
    file[10] = 9;
    seal(&mut file);
    file.extend([0xFF; 37]);
    assert!(Bssrdf::parse(&file).is_ok(), "minor 9, flash padding behind");
}

#[test]
fn alignment_does_not_matter() {
    let file = example();
    for shift in 0..8 {
        let mut shifted = vec![0xAA; shift];
        shifted.extend(&file);
        let material = Bssrdf::parse(&shifted[shift..]).unwrap();
        assert_eq!(material.rd([0, 0], [1, 0]), Bssrdf::parse(&file).unwrap().rd([0, 0], [1, 0]));
    }
}

#[test]
fn errors_say_section_offset_and_numbers() {
    let message = refused(|f| f[BIDX] = 200).to_string();
    assert_eq!(message, "BIDX (base-material indices): byte 212: index 200, but the table has 2 entries");
    let mut file = example();
    file[PROF] ^= 1;
    let error = Bssrdf::parse(&file).unwrap_err();
    assert!(error.to_string().starts_with("PROF (base scattering profiles): is damaged, CRC-32 "), "{error}");
    assert!(Bssrdf::parse_with(&file, Crc::Skip).is_ok(), "the value itself is a legal one");
}
