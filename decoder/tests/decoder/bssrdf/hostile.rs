//! Hostile input: every outcome is an error or a bounded value.

use crate::common::damage::Sound;
use crate::common::example;
use proptest::prelude::*;
use subsurf_decoder::Bssrdf;

/// Uses everything a parsed file offers and checks the bounds that hold for any file.
fn exercise(material: &Bssrdf<'_>) {
    let far = [i32::MIN, -3, -1, 0, 1, 2, i32::MAX];
    for (a, b) in far.iter().flat_map(|&a| far.map(|b| (a, b))) {
        let rd = material.rd([a, b], [b, a]);
        assert!(rd.iter().all(|v| v.is_finite() && *v >= 0.0), "{rd:?}");
        // A window of 1,023 pixels is legal, but four million terms are no test.
        if material.header().window_radius < 4 {
            let albedo = material.albedo([a, b]);
            assert!(albedo.iter().all(|v| !v.is_nan() && *v >= 0.0), "{albedo:?}");
        }
    }
}

fn sound() -> Sound {
    let open = |bytes: &[u8], crc| Bssrdf::parse_with(bytes, crc).map(|material| exercise(&material));
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
    fn any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(Bssrdf::parse(&bytes).is_err());
    }

    #[test]
    fn any_sections_behind_a_sound_start(bytes in proptest::collection::vec(any::<u8>(), 124..400)) {
        sound().begin(bytes);
    }

    #[test]
    fn any_damage_with_valid_crcs(changes in proptest::collection::vec((8_usize..216, any::<u8>()), 1..6)) {
        sound().change(&changes);
    }
}
