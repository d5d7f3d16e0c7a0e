//! The front door: what a file holds, and files of another family or of none.

use crate::common::{example, seal, seal_all, with_section};
use subsurf_decoder::btf::Catalog;
use subsurf_decoder::container::Crc;
use subsurf_decoder::{Bssrdf, Content, FactoredBtf, Family, File, NestedBtf, ReadError, Section};

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
fn btfs_alone_have_a_catalog() {
    for (name, texels) in
        [("nested_display", Some(6)), ("factored", Some(7)), ("kernel_example", None), ("one_pixel", None)]
    {
        let bytes = std::fs::read(format!("../tests/vectors/{name}.subsurf")).unwrap();
        let file = File::parse(&bytes).unwrap();
        let content = file.content();
        assert_eq!(content.catalog().map(Catalog::texels), texels, "{name}");
    }
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
    bytes[24..28].copy_from_slice(b"xxxx");
    seal(&mut bytes);
    assert_eq!(File::parse(&bytes).unwrap_err(), ReadError::UnknownContent);
    assert_eq!(NestedBtf::parse(&bytes).unwrap_err(), ReadError::Missing { section: Section::BtfHeader });
}

#[test]
fn a_file_with_the_headers_of_two_families_is_refused() {
    let mut bytes = example();
    bytes[72..76].copy_from_slice(b"KERN");
    seal(&mut bytes);
    let error = ReadError::TwoFamilies { headers: [Section::BssrdfHeader, Section::KernelHeader] };
    assert_eq!(File::parse(&bytes).unwrap_err(), error);
    assert_eq!(Bssrdf::parse(&bytes).unwrap_err(), error);
    assert_eq!(NestedBtf::parse(&bytes).unwrap_err(), error);
}

#[test]
fn a_section_of_a_newer_version_is_refused_unless_its_first_letter_is_lower_case() {
    for kind in [b"XTRA", b"Xtra", b"1tra", b"\xE1tra"] {
        let error = File::parse(&with_section(kind, &[1, 2, 3])).unwrap_err();
        assert_eq!(error, ReadError::NewerSection { section: Section::Other(*kind) }, "{error}");
        assert!(error.to_string().contains("made by a newer version"), "{error}");
    }
    for kind in [b"xtra", b"xTRA", b"a\0\0\xFF"] {
        assert!(
            File::parse(&with_section(kind, &[1, 2, 3])).is_ok(),
            "{}: its CRC is not looked at",
            kind.escape_ascii()
        );
    }
}

#[test]
fn headers_may_be_longer_than_they_are_known() {
    let mut bytes = example();
    // PROF follows at once; what is between both is fill, which the header now takes.
    bytes.splice(156..156, [7, 7, 7, 7]);
    bytes[16] += 4;
    bytes[24 + 16] += 4;
    for entry in 1..4 {
        bytes[24 + 24 * entry + 8] += 4;
    }
    seal(&mut bytes);
    assert_eq!(Bssrdf::parse(&bytes).unwrap().header(), Bssrdf::parse(&example()).unwrap().header());
    bytes[24 + 16] -= 5;
    seal(&mut bytes);
    let error = ReadError::WrongSize { section: Section::BssrdfHeader, need_bytes: 32, have_bytes: 31 };
    assert_eq!(Bssrdf::parse(&bytes).unwrap_err(), error);
}

#[test]
fn metadata_is_read_in_order_and_skips_what_is_no_text() {
    let section = [
        &[4, 0, 4, 0][..],
        b"namejade",
        &[1, 0, 1, 0],
        &[b'k', 0xFF],
        &[6, 9, 7, 0],
        "author".as_bytes(),
        "J. Doé".as_bytes(),
        &[0, 0, 3, 0],
        b"???",
        &[4, 0, 0, 0],
        b"tool",
        &[5, 0, 9, 0],
        b"cut",
    ]
    .concat();
    let bytes = with_section(b"meta", &section);
    let file = File::parse(&bytes).unwrap();
    // Its CRC is none of the file's content.
    assert!(matches!(file.container().metadata(), Err(ReadError::Checksum { section: Section::Metadata, .. })), "CRC");
    let mut sealed = bytes.clone();
    seal_all(&mut sealed, 5);
    let file = File::parse(&sealed).unwrap();
    let found: Vec<_> = file.container().metadata().unwrap().collect();
    assert_eq!(found, [("name", "jade"), ("author", "J. Doé"), ("tool", "")]);
    let example = example();
    assert_eq!(File::parse(&example).unwrap().container().metadata().unwrap().count(), 0, "none");
}

#[test]
fn checksums_are_compared_unless_they_are_not_wanted() {
    let mut bytes = example();
    bytes[crate::common::PROF] ^= 1;
    assert!(matches!(File::parse(&bytes), Err(ReadError::Checksum { .. })), "damaged");
    assert!(File::parse_with(&bytes, Crc::Skip).is_ok(), "the value itself is a legal one");
}
