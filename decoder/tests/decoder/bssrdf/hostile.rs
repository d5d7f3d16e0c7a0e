//! Hostile input: every outcome is an error or a bounded value.

use crate::common::{example, seal};
use proptest::prelude::*;
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Bssrdf, ReadError};

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

#[test]
fn cut_at_every_length() {
    let file = example();
    for length in 0..file.len() {
        let error = Bssrdf::parse(&file[..length]).unwrap_err();
        assert!(matches!(error, ReadError::Truncated { .. }), "{length}: {error:?}");
    }
}

#[test]
fn every_bit_of_every_byte_flipped() {
    let file = example();
    for at in 0..file.len() {
        for bit in 0..8 {
            let mut bad = file.clone();
            bad[at] ^= 1 << bit;
            assert!(Bssrdf::parse(&bad).is_err(), "a CRC covers byte {at}");
            if let Ok(material) = Bssrdf::parse_with(&bad, Crc::Skip) {
                exercise(&material);
            }
            // The same damage by someone who recomputes the CRCs.
            seal(&mut bad);
            if let Ok(material) = Bssrdf::parse(&bad) {
                exercise(&material);
            }
        }
    }
}

proptest! {
    #[test]
    fn any_bytes(bytes in proptest::collection::vec(any::<u8>(), 0..400)) {
        prop_assert!(Bssrdf::parse(&bytes).is_err());
    }

    #[test]
    fn any_sections_behind_a_sound_start(bytes in proptest::collection::vec(any::<u8>(), 124..400)) {
        // Magic, version, section count and size as they are in a file of this length, and CRCs made to fit.
        let mut file = bytes;
        let len = file.len() as u64;
        file[..16].copy_from_slice(&example()[..16]);
        file[16..24].copy_from_slice(&len.to_le_bytes());
        seal(&mut file);
        if let Ok(material) = Bssrdf::parse(&file) {
            exercise(&material);
        }
    }

    #[test]
    fn any_damage_with_valid_crcs(
        changes in proptest::collection::vec((8_usize..216, any::<u8>()), 1..6),
    ) {
        let mut file = example();
        for (at, value) in changes {
            file[at] = value;
        }
        seal(&mut file);
        if let Ok(material) = Bssrdf::parse(&file) {
            exercise(&material);
        }
    }
}
