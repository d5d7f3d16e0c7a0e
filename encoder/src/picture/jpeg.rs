//! Whether a JPEG file is whole.

use std::io;
use std::path::Path;

const SCAN: u8 = 0xDA;
const END: [u8; 2] = [0xFF, 0xD9];

/// Whether the first scan of a JPEG file has an end. Decoders fill in grey for what a file that was cut
/// does not have.
pub(super) fn is_whole(path: &Path) -> io::Result<bool> {
    Ok(has_end(&std::fs::read(path)?))
}

/// What is no sequence of segments is left to decoders.
fn has_end(file: &[u8]) -> bool {
    let mut at = 2;
    // Segments, such as one with a thumbnail, up to the first scan: 0xFF, a marker, and a length that counts itself.
    loop {
        match file.get(at..).and_then(|rest| rest.first_chunk::<4>()) {
            Some([0xFF, 0xFF, ..]) => at += 1,
            Some([0xFF, SCAN, ..]) => break,
            Some([0xFF, _, high, low]) => at += 2 + usize::from(u16::from_be_bytes([*high, *low])),
            Some(_) => return true,
            None => return false,
        }
    }
    // In a scan, 0xFF is followed by 0 where it is data.
    file[at..].windows(END.len()).any(|pair| pair == END)
}
