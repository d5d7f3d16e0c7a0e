//! Containers: header and section table, exactly at their limits, and what writers put there.

use crate::common::{assemble, crc32, example, seal};
use subsurf_decoder::container::{
    Container, Crc, ENTRY_BYTES, Entry, FILE_HEADER_BYTES, MAX_KEY_BYTES, MAX_SECTIONS, MAX_VALUE_BYTES, entry_header,
    file_header,
};
use subsurf_decoder::{ReadError, Section};

/// Bytes of a header of so many sections.
fn header_bytes(sections: usize) -> usize {
    FILE_HEADER_BYTES + sections * ENTRY_BYTES + 4
}

/// File of so many sections without bytes that readers skip.
fn empty_sections(count: u8) -> Vec<u8> {
    let kinds: Vec<[u8; 4]> = (0..count).map(|k| [b'x', b'0', b'0' + k / 10, b'0' + k % 10]).collect();
    assemble(&kinds.iter().map(|kind| (kind, &[][..])).collect::<Vec<_>>())
}

#[test]
fn one_to_64_sections() {
    for count in [1, 2, 64] {
        let file = empty_sections(count);
        assert_eq!(file.len(), header_bytes(count.into()));
        let container = Container::parse(&file).unwrap();
        assert_eq!((container.entries().count(), container.file().len()), (count.into(), file.len()));
    }
    for count in [0, 65] {
        let due = ReadError::SectionCount { count: count.into(), limit: MAX_SECTIONS };
        assert_eq!(Container::parse(&empty_sections(count)).unwrap_err(), due);
    }
}

#[test]
fn a_file_is_as_long_as_it_says() {
    let file = example();
    let with_length = |length: u64| {
        let mut file = file.clone();
        file[16..24].copy_from_slice(&length.to_le_bytes());
        seal(&mut file);
        Container::parse(&file).map(|container| container.file().len())
    };
    let truncated = |section, need_bytes, have_bytes| ReadError::Truncated { section, need_bytes, have_bytes };
    assert_eq!(with_length(216), Ok(216));
    assert_eq!(with_length(217), Err(truncated(Section::FileHeader, 217, 216)), "a byte is missing");
    assert_eq!(with_length(215), Err(truncated(Section::BaseIndices, 216, 215)), "sections end with the file");
    assert_eq!(with_length(124), Err(truncated(Section::BssrdfHeader, 156, 124)), "nothing but a header");
    assert_eq!(with_length(123), Err(truncated(Section::FileHeader, 124, 123)), "the header's last byte");
    assert_eq!(with_length(0), Err(truncated(Section::FileHeader, 124, 0)), "as it says itself");
}

#[test]
fn a_short_file_is_told_from_another_kind_of_file() {
    let file = example();
    let truncated = |need_bytes, have: usize| ReadError::Truncated {
        section: Section::FileHeader,
        need_bytes,
        have_bytes: have as u64,
    };
    for length in 0..FILE_HEADER_BYTES {
        assert_eq!(Container::parse(&file[..length]).unwrap_err(), truncated(24, length), "{length}");
    }
    assert_eq!(Container::parse(&file[..FILE_HEADER_BYTES]).unwrap_err(), truncated(216, FILE_HEADER_BYTES));
    for at in 0..8 {
        let mut other = file[..=at].to_vec();
        other[at] ^= 1;
        assert_eq!(Container::parse(&other).unwrap_err(), ReadError::NotSubsurf, "byte {at}");
    }
    // What is known of a short file is said: its version, then its number of sections.
    let mut newer = file.clone();
    (newer[8], newer[10]) = (2, 7);
    assert_eq!(Container::parse(&newer[..12]).unwrap_err(), ReadError::NewerVersion { major: 2, minor: 7 });
    assert_eq!(Container::parse(&newer[..11]).unwrap_err(), truncated(24, 11));
    let mut many = file;
    many[12] = 65;
    assert_eq!(Container::parse(&many[..16]).unwrap_err(), ReadError::SectionCount { count: 65, limit: 64 });
    assert_eq!(Container::parse(&many[..15]).unwrap_err(), truncated(24, 15));
}

#[test]
fn sections_may_touch_and_not_overlap() {
    let with_offset = |entry: usize, offset: u64| {
        let mut file = example();
        let at = FILE_HEADER_BYTES + entry * ENTRY_BYTES + 8;
        file[at..at + 8].copy_from_slice(&offset.to_le_bytes());
        seal(&mut file);
        Container::parse(&file).err()
    };
    let overlap = |section, offset, earliest| Some(ReadError::Overlap { section, offset, earliest });
    assert_eq!(with_offset(0, 124), None, "at the end of the table");
    assert_eq!(with_offset(0, 123), overlap(Section::BssrdfHeader, 123, 124));
    assert_eq!(with_offset(0, 125), overlap(Section::BaseProfiles, 156, 157));
    assert_eq!(with_offset(3, 212), None, "at the end of the one before");
    assert_eq!(with_offset(3, 211), overlap(Section::BaseIndices, 211, 212));
    let truncated =
        |need_bytes| Some(ReadError::Truncated { section: Section::BaseIndices, need_bytes, have_bytes: 216 });
    assert_eq!(with_offset(3, 213), truncated(217));
    assert_eq!(with_offset(3, u64::MAX), truncated(u64::MAX), "beyond what numbers hold");
}

#[test]
fn sections_are_found_and_compared() {
    let mut file = example();
    file[10] = 3;
    seal(&mut file);
    let container = Container::parse(&file).unwrap();
    assert_eq!(container.minor(), 3);
    let (entry, bytes) = container.section(Section::BaseIndices, Crc::Check).unwrap();
    assert_eq!(
        (entry.section, entry.offset, entry.length, entry.crc),
        (Section::BaseIndices, 212, 4, crc32(&[0, 1, 1, 0]))
    );
    assert_eq!(bytes, [0, 1, 1, 0]);
    assert_eq!(
        container.section(Section::Codes, Crc::Skip).unwrap_err(),
        ReadError::Missing { section: Section::Codes }
    );
    file[215] = 1;
    let container = Container::parse(&file).unwrap();
    let (stored, computed) = (crc32(&[0, 1, 1, 0]), crc32(&[0, 1, 1, 1]));
    let due = ReadError::Checksum { section: Section::BaseIndices, stored, computed };
    assert_eq!(container.section(Section::BaseIndices, Crc::Check).unwrap_err(), due);
    assert_eq!(container.section(Section::BaseIndices, Crc::Skip).unwrap().1, [0, 1, 1, 1]);
    // The header's own is always compared.
    file[30] ^= 1;
    assert!(matches!(Container::parse(&file), Err(ReadError::Checksum { section: Section::FileHeader, .. })), "CRC");
}

#[test]
fn writers_put_down_what_readers_read() {
    let file = example();
    assert_eq!(file_header(4, 216), file[..FILE_HEADER_BYTES]);
    let entries: Vec<Entry> = Container::parse(&file).unwrap().entries().collect();
    for (entry, bytes) in entries.iter().zip(file[FILE_HEADER_BYTES..].chunks_exact(ENTRY_BYTES)) {
        assert_eq!(entry.to_bytes(), bytes);
    }
    assert_eq!(entry_header("ab", "cdé"), Some([2, 0, 4, 0]));
    let (key, value) = ("k".repeat(MAX_KEY_BYTES), "v".repeat(MAX_VALUE_BYTES));
    assert_eq!(entry_header(&key, &value), Some([0xFF, 0, 0xFF, 0xFF]));
    assert_eq!(entry_header(&(key + "k"), "v"), None, "a key of 256 bytes");
    assert_eq!(entry_header("k", &(value + "v")), None, "a value of 65,536 bytes");
}
