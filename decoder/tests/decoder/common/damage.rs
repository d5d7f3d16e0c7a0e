//! Damage that files of every family take without harm.

use std::ops::Range;

use subsurf_decoder::ReadError;
use subsurf_decoder::container::Crc;

use super::seal_all;

/// A sound file, and how it is opened.
pub(crate) struct Sound {
    pub(crate) file: Vec<u8>,
    pub(crate) sections: usize,
    /// Opens a file, and uses everything that it offers.
    pub(crate) open: fn(&[u8], Crc) -> Result<(), ReadError>,
}

impl Sound {
    pub(crate) fn cut_at_every_length(&self) {
        for length in 0..self.file.len() {
            let error = (self.open)(&self.file[..length], Crc::Check).unwrap_err();
            assert!(matches!(error, ReadError::Truncated { .. }), "{length}: {error:?}");
        }
    }

    /// Flips every bit of every byte. Bytes of `fill` are those between sections, which no CRC covers.
    pub(crate) fn flip_every_bit(&self, fill: &[Range<usize>]) {
        for (at, bit) in (0..self.file.len()).flat_map(|at| (0..8).map(move |bit| (at, bit))) {
            let mut bad = self.file.clone();
            bad[at] ^= 1 << bit;
            assert_eq!(
                (self.open)(&bad, Crc::Check).is_ok(),
                fill.iter().any(|fill| fill.contains(&at)),
                "byte {at}: covered by a CRC unless it is fill"
            );
            (self.open)(&bad, Crc::Skip).ok();
            // The same damage by someone who recomputes the CRCs.
            self.open_sealed(bad);
        }
    }

    /// Puts other bytes at some places.
    pub(crate) fn change(&self, changes: &[(usize, u8)]) {
        let mut bad = self.file.clone();
        changes.iter().for_each(|(at, value)| bad[*at] = *value);
        self.open_sealed(bad);
    }

    /// Puts magic, version, number of sections and size before any bytes.
    pub(crate) fn begin(&self, mut bytes: Vec<u8>) {
        let len = bytes.len() as u64;
        bytes[..16].copy_from_slice(&self.file[..16]);
        bytes[16..24].copy_from_slice(&len.to_le_bytes());
        self.open_sealed(bytes);
    }

    fn open_sealed(&self, mut file: Vec<u8>) {
        seal_all(&mut file, self.sections);
        (self.open)(&file, Crc::Check).ok();
    }
}
