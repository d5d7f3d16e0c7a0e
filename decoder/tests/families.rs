//! The front door: what a file holds, and files of another family or of none.

mod common;

use common::{example, seal};
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Content, FactoredBtf, Family, File, NestedBtf, ReadError, Section};

#[test]
fn the_front_door_tells_what_a_file_holds() {
    let bytes = example();
    let file = File::parse(&bytes).unwrap();
    let Content::Bssrdf(material) = file.content() else { panic!("the example is a BSSRDF") };
    assert_eq!((material.header().width, file.content().family()), (2, Family::Bssrdf));
    let sections: Vec<Section> = file.container().entries().map(|entry| entry.section).collect();
    assert_eq!(sections[..2], [Section::BssrdfHeader, Section::BaseProfiles]);
}

#[test]
fn another_family_is_named() {
    let bytes = example();
    let expected = [
        (NestedBtf::parse(&bytes).unwrap_err(), "a BSSRDF, not a nested BTF"),
        (FactoredBtf::parse(&bytes).unwrap_err(), "a BSSRDF, not a factored BTF"),
    ];
    for (error, message) in expected {
        assert!(matches!(error, ReadError::OtherFamily { found: Family::Bssrdf, .. }), "{error:?}");
        assert_eq!(error.to_string(), message);
    }
}

#[test]
fn a_file_without_a_known_header_has_unknown_content() {
    let mut bytes = example();
    bytes[24..28].copy_from_slice(b"XXXX");
    seal(&mut bytes);
    assert_eq!(File::parse(&bytes).unwrap_err(), ReadError::UnknownContent);
    assert_eq!(NestedBtf::parse(&bytes).unwrap_err(), ReadError::Missing { section: Section::BtfHeader });
}

#[test]
fn checksums_are_compared_unless_they_are_not_wanted() {
    let mut bytes = example();
    bytes[common::PROF] ^= 1;
    assert!(matches!(File::parse(&bytes), Err(ReadError::Checksum { .. })), "damaged");
    assert!(File::parse_with(&bytes, Crc::Skip).is_ok(), "the value itself is a legal one");
}
