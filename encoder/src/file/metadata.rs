//! What people want to know of a file, as keys and values in it (`FORMAT.md`, section 1.2).

use subsurf_decoder::Section;
use subsurf_decoder::container::{Container, ENTRY_BYTES, MAX_KEY_BYTES, MAX_VALUE_BYTES, entry_header};

use crate::error::{Error, Result};
use crate::file::container;

/// The same file with these keys and values; a key that it has already gets the new value, an empty value takes the key out. Metadata that is
/// damaged counts as none.
///
/// # Errors
/// [`Error::Request`] if the bytes are no file, for a key that is empty or longer than 255 bytes, and for a value of more than 65,535 bytes.
pub fn with_metadata(file: &[u8], entries: &[(String, String)]) -> Result<Vec<u8>> {
    if entries.is_empty() {
        return Ok(file.to_vec());
    }
    let container = Container::parse(file).map_err(|error| Error::Request(error.to_string()))?;
    let all = merged(container.metadata().into_iter().flatten(), entries);
    let section = section(&all)?;
    container::with_section(file, Section::Metadata, Some(&section[..]).filter(|section| !section.is_empty()))
}

/// Bytes that such metadata adds to a file without any, at most.
///
/// # Errors
/// [`Error::Request`] as [`with_metadata`].
pub fn metadata_bytes(entries: &[(String, String)]) -> Result<u64> {
    let all = merged(std::iter::empty(), entries);
    // With the fill before it.
    Ok(if all.is_empty() { 0 } else { (ENTRY_BYTES + section(&all)?.len() + 3) as u64 })
}

/// Keys and values of a file after changes: every key once, with its last value.
fn merged<'a>(
    before: impl Iterator<Item = (&'a str, &'a str)>,
    entries: &'a [(String, String)],
) -> Vec<(&'a str, &'a str)> {
    let mut all: Vec<(&str, &str)> = Vec::new();
    for (key, value) in before.chain(entries.iter().map(|(key, value)| (key.as_str(), value.as_str()))) {
        all.retain(|(other, _)| *other != key);
        if !value.is_empty() {
            all.push((key, value));
        }
    }
    all
}

fn section(entries: &[(&str, &str)]) -> Result<Vec<u8>> {
    let mut bytes = Vec::new();
    for (key, value) in entries {
        let header = entry_header(key, value).ok_or_else(|| {
            let lengths = [key.len(), value.len()];
            Error::Request(format!(
                "metadata {:?}: {lengths:?} bytes of key and value; a key has 1 to {MAX_KEY_BYTES}, a value up to {MAX_VALUE_BYTES}",
                key.chars().take(40).collect::<String>(),
            ))
        })?;
        bytes.extend(header);
        bytes.extend_from_slice(key.as_bytes());
        bytes.extend_from_slice(value.as_bytes());
    }
    Ok(bytes)
}

#[cfg(test)]
mod tests {
    use subsurf_decoder::bssrdf::Addressing;

    use super::*;
    use crate::synthetic::Shape;

    fn entries(all: &[(&str, &str)]) -> Vec<(String, String)> {
        all.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect()
    }

    #[test]
    fn keys_are_added_replaced_and_taken_out() {
        let shape = Shape { size: [4, 3], radius: 1, samples: 2, base_materials: 2, addressing: Addressing::Clamp };
        let plain = shape.bmpp();
        let first = entries(&[("name", "jade"), ("author", "J. Doé"), ("licence", "CC0-1.0")]);
        let file = with_metadata(&plain, &first).unwrap();
        let added = (file.len() - plain.len()) as u64;
        assert!((added..=added + 3).contains(&metadata_bytes(&first).unwrap()), "{added}");
        let file = with_metadata(&file, &entries(&[("name", "green jade"), ("author", "")])).unwrap();
        let container = Container::parse(&file).unwrap();
        let found: Vec<_> = container.metadata().unwrap().collect();
        assert_eq!(found, [("licence", "CC0-1.0"), ("name", "green jade")]);
        assert_eq!(with_metadata(&plain, &[]).unwrap(), plain);
        let none = with_metadata(&file, &entries(&[("licence", ""), ("name", ""), ("tool", "")])).unwrap();
        assert!(none == plain, "no key, no section");
        assert_eq!(metadata_bytes(&entries(&[("name", "a"), ("name", "")])).unwrap(), 0);
    }

    #[test]
    fn other_sections_stay_in_order_and_damaged_metadata_is_replaced() {
        let shape = Shape { size: [4, 3], radius: 1, samples: 2, base_materials: 2, addressing: Addressing::Clamp };
        let named = with_metadata(&shape.bmpp(), &entries(&[("name", "jade")])).unwrap();
        let extra = container::with_section(&named, Section::from_kind(*b"xtra"), Some(b"123")).unwrap();
        let kinds: Vec<Section> = Container::parse(&extra).unwrap().entries().map(|entry| entry.section).collect();
        assert_eq!(kinds.last(), Some(&Section::Metadata), "behind all others");

        // The last byte of the file is one of the name.
        let mut damaged = extra.clone();
        *damaged.last_mut().unwrap() ^= 1;
        let mended = with_metadata(&damaged, &entries(&[("name", "jade")])).unwrap();
        assert!(mended == extra, "read as none, and written anew");
        assert!(
            container::with_section(&damaged, Section::from_kind(*b"xtra"), None)
                .is_ok_and(|file| { Container::parse(&file).unwrap().metadata().is_err() }),
            "what is damaged stays damaged where it is not replaced"
        );
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let long =
            [("k".repeat(256), "v".to_owned()), ("k".to_owned(), "v".repeat(65_536)), (String::new(), "v".to_owned())];
        for entry in long {
            let error = metadata_bytes(&[entry]).unwrap_err().to_string();
            assert!(error.contains("a key has 1 to 255, a value up to 65535"), "{error}");
        }
    }
}
