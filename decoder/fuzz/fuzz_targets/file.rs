//! Front door: files of any family, with checksums compared and not; what every container and every error has in common.
#![no_main]

use libfuzzer_sys::{fuzz_mutator, fuzz_target};
use subsurf_decoder::container::{Crc, FILE_HEADER_BYTES};
use subsurf_decoder::{Bssrdf, Content, FactoredBtf, File, Kernel, NestedBtf, ReadError, Section, Transfer};
use subsurf_fuzz::{check_error, mutate};

fuzz_mutator!(|data: &mut [u8], size: usize, max_size: usize, seed: u32| {
    mutate(data, size, max_size, seed, Section::BssrdfHeader)
});

fuzz_target!(|input: &[u8]| {
    let (trusted, checked) = (File::parse_with(input, Crc::Skip), File::parse(input));
    match (&trusted, &checked) {
        (Ok(trusted), Ok(checked)) => {
            assert_eq!(trusted.content().family(), checked.content().family(), "one family");
            container(checked, input);
        }
        (Ok(_), Err(error)) => assert!(matches!(error, ReadError::Checksum { .. }), "{error}"),
        (Err(error), Ok(_)) => panic!("not refused where checksums are compared: {error}"),
        (Err(error), Err(also)) => {
            let is_same = std::mem::discriminant(error) == std::mem::discriminant(also);
            assert!(is_same || matches!(also, ReadError::Checksum { .. }), "{error}; {also}");
        }
    }
    for error in [trusted.err(), checked.err()].into_iter().flatten() {
        check_error(error, input);
    }
});

/// A file that was accepted: its sections, the readers of other families, and other ends.
fn container(file: &File<'_>, input: &[u8]) {
    let (container, family) = (file.container(), file.content().family());
    let bytes = container.file();
    assert_eq!(bytes, &input[..bytes.len()], "the file is what the input begins with");
    let mut end = FILE_HEADER_BYTES as u64;
    let mut seen = Vec::new();
    for entry in container.entries() {
        assert!(entry.offset >= end, "{} begins where another one is", entry.section);
        end = entry.offset + entry.length;
        assert!(!seen.contains(&entry.section), "{} is there twice", entry.section);
        assert_eq!(Section::from_kind(entry.section.kind()), entry.section, "a section has one name");
        let (found, section) = container.section(entry.section, Crc::Skip).expect("a section that is listed");
        assert_eq!(section, &bytes[entry.offset as usize..end as usize], "{} is where it says", found.section);
        seen.push(entry.section);
    }
    assert!(end <= bytes.len() as u64, "sections end with the file");
    match container.metadata() {
        Ok(metadata) => {
            let text: usize = metadata.map(|(key, value)| key.len() + value.len()).sum();
            assert!(text <= bytes.len(), "what is said of a file stands in it");
        }
        Err(error) => assert!(matches!(error, ReadError::Checksum { section: Section::Metadata, .. }), "{error}"),
    }

    let others = [
        (Bssrdf::parse(input).err(), matches!(file.content(), Content::Bssrdf(_))),
        (NestedBtf::parse(input).err(), matches!(file.content(), Content::NestedBtf(_))),
        (FactoredBtf::parse(input).err(), matches!(file.content(), Content::FactoredBtf(_))),
        (Kernel::parse(input).err(), matches!(file.content(), Content::Kernel(_))),
        (Transfer::parse(input).err(), matches!(file.content(), Content::Transfer(_))),
    ];
    for (error, is_family) in others {
        match error {
            None => assert!(is_family, "read as another family"),
            Some(error) => assert!(!is_family && matches!(error, ReadError::OtherFamily { .. }), "{error}"),
        }
    }
    let exact = File::parse(bytes).expect("the file without what follows it");
    assert_eq!(exact.content().family(), family, "what follows a file is ignored");
    let cut = File::parse(&bytes[..bytes.len() - 1]).expect_err("a byte less");
    assert!(matches!(cut, ReadError::Truncated { .. }), "{cut}");
}
