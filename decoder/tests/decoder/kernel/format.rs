//! Kernel files: the reader against the words of `FORMAT.md`, section 6, and hostile ones.

use crate::common::damage::Sound;
use crate::common::seal;
use proptest::prelude::*;
use subsurf_decoder::kernel::KernelMethod;
use subsurf_decoder::{Bssrdf, Content, Family, File, Kernel, ReadError};

/// The 232 bytes of section 6.3, from literals: nothing here uses the crate's own layout.
#[rustfmt::skip]
fn example() -> Vec<u8> {
    let mut file = crate::common::begin(0xE8, [(b"KERN", 124, 24), (b"KOFF", 148, 12), (b"KWGT", 160, 36), (b"TAIL", 196, 36)]);
    file.extend([
        0x02, 0x01, 0x01, 0x05,                          // pre-integrated, colour space, 1 term, 5 taps
        0x03, 0x00, 0x00, 0x00,                          // m
        0x00, 0x00, 0x00, 0x00,                          // signs
        0x00, 0x00, 0x00, 0x40,                          // radius 2.0
        0x00, 0x00, 0x80, 0x3F,                          // depth_variance 1.0
        0x00, 0x00, 0xC0, 0x3F,                          // eta 1.5
    ]);
    let numbers: [f32; 21] = [
        0.0, 0.5, 1.0,                                   // o
        0.5, 0.5, 0.5, 0.125, 0.0625, 0.0, 0.0625, 0.0, 0.0, // w
        49.0 / 64.0, 25.0 / 64.0, 0.25, 0.25, 0.125, 0.0625, 0.0, 0.0, 0.0, // T
    ];
    file.extend(numbers.iter().flat_map(|value| value.to_le_bytes()));
    seal(&mut file);
    file
}

/// Uses everything a parsed file offers and checks the bounds that hold for any file.
fn exercise(kernel: &Kernel<'_>) {
    let header = kernel.header();
    let radius = header.radius_mm;
    let mut most = [1.0; 3];
    for d in [-1.0, 0.0, 1e-9 * radius, 0.1 * radius, 0.5 * radius, 0.999 * radius, radius, f32::INFINITY] {
        let (tail, rd) = (kernel.tail_at(d), kernel.rd(d));
        for c in 0..3 {
            assert!((0.0..=most[c] * 1.000_001).contains(&tail[c]), "T({d}) = {tail:?} after {most:?}");
            assert!(rd[c].is_finite() && rd[c] >= 0.0, "Rd({d}) = {rd:?}");
        }
        most = tail;
    }
    let none = [kernel.tail_at(radius), kernel.rd(f32::NAN), kernel.tail_at(f32::NAN)];
    assert_eq!(none, [[0.0; 3]; 3], "nothing beyond the radius, nothing at NaN");
    for (energy, reflectance) in kernel.energy().into_iter().zip(kernel.reflectance()) {
        assert!((energy - reflectance).abs() < 0.001, "{energy}, {reflectance}");
    }
    for (term, tap) in (0..8).flat_map(|term| (0..40).map(move |tap| (term, tap))) {
        assert!(kernel.weight(term, tap).iter().all(|w| w.abs() <= 16.0), "weight {term}, {tap}");
        assert_eq!(kernel.sign(term) == [0.0; 3], term >= header.terms.into(), "{term}");
    }
    assert_eq!(kernel.offsets().len(), header.side(), "one offset for each tap of a side");
}

#[test]
fn reads_the_example() {
    let bytes = example();
    assert_eq!(bytes, include_bytes!("../../../../tests/vectors/kernel_example.subsurf"));
    let Content::Kernel(kernel) = File::parse(&bytes).unwrap().content() else { panic!("the example is a kernel") };
    let header = kernel.header();
    assert_eq!((header.method, header.terms, header.taps, header.side()), (KernelMethod::PreIntegrated, 1, 5, 3));
    assert_eq!((header.radius_mm, header.depth_variance, header.eta), (2.0, 1.0, 1.5));
    assert!(kernel.offsets().iter().eq([0.0, 0.5, 1.0]), "offsets in file order");
    assert_eq!([0, 1, 2, 3].map(|tap| kernel.weight(0, tap)[0]), [0.5, 0.125, 0.0625, 0.0]);
    assert_eq!([kernel.sign(0), kernel.sign(1)], [[1.0; 3], [0.0; 3]]);
    assert_eq!(kernel.energy(), [49.0 / 64.0, 25.0 / 64.0, 0.25]);
    assert_eq!(kernel.energy(), kernel.reflectance());
    assert_eq!(kernel.two_gaussians(), None);
    // Nodes at 0, 0.5 and 2 mm. √(0.125 / 2) = ¼ is half way to the first node, √(1.125 / 2) = ¾ half way from it to the last.
    assert_eq!(kernel.tail_at(0.5), [0.25, 0.125, 0.0625]);
    assert_eq!(kernel.tail_at(0.125)[2], 0.5 * (0.25 + 0.0625));
    assert_eq!(kernel.tail_at(1.125)[2], 0.5 * 0.0625);
    // Rings of π/4 and of π (4 − ¼) mm².
    let close = |found: f32, expected: f64| (f64::from(found) - expected).abs() < 1e-6;
    assert!(close(kernel.rd(0.1)[0], (49.0 / 64.0 - 0.25) * 4.0 / std::f64::consts::PI), "{:?}", kernel.rd(0.1));
    assert!(close(kernel.rd(1.9)[1], 0.125 / (3.75 * std::f64::consts::PI)), "{:?}", kernel.rd(1.9));
    exercise(&kernel);
}

#[test]
fn signs_are_bits() {
    // Two terms: the second takes green away, and adds nothing else.
    let mut file = example();
    file[126] = 2;
    file[132..134].copy_from_slice(&[0x10, 0]);
    file.splice(196..196, [0_u8; 36]);
    file[196..208].copy_from_slice(&[[0; 4], 0.5_f32.to_le_bytes(), [0; 4]].concat());
    let taken = 25.0_f32 / 64.0 - 0.25;
    file[236..240].copy_from_slice(&taken.to_le_bytes());
    for (entry, bytes) in [(72 + 16, 72_u8), (96 + 8, 232)] {
        file[entry] = bytes;
    }
    file[16..18].copy_from_slice(&268_u16.to_le_bytes());
    seal(&mut file);
    let kernel = Kernel::parse(&file).unwrap();
    assert_eq!(kernel.sign(1), [1.0, -1.0, 1.0]);
    assert_eq!(kernel.energy()[1], taken);
    exercise(&kernel);
}

#[test]
fn other_families_are_told_apart() {
    let (kernel, bssrdf) = (example(), crate::common::example());
    let other = |found, expected| ReadError::OtherFamily { found, expected };
    assert_eq!(Bssrdf::parse(&kernel).unwrap_err(), other(Family::Kernel, Family::Bssrdf));
    let error = Kernel::parse(&bssrdf).unwrap_err();
    assert_eq!(error, other(Family::Bssrdf, Family::Kernel));
    assert_eq!(error.to_string(), "a BSSRDF, not a kernel");
}

fn sound() -> Sound {
    let open = |bytes: &[u8], crc| Kernel::parse_with(bytes, crc).map(|kernel| exercise(&kernel));
    Sound { file: example(), sections: 4, open }
}

#[test]
fn cut_at_every_length() {
    sound().cut_at_every_length();
}

#[test]
fn every_bit_of_every_byte_flipped() {
    sound().flip_every_bit(&[]);
}

proptest! {
    #[test]
    fn any_sections_behind_a_sound_start(bytes in proptest::collection::vec(any::<u8>(), 124..400)) {
        sound().begin(bytes);
    }

    #[test]
    fn any_damage_with_valid_crcs(changes in proptest::collection::vec((8_usize..232, any::<u8>()), 1..6)) {
        sound().change(&changes);
    }
}
