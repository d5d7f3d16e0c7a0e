//! Files for readers of pushed bytes, and what comes of them.

use subsurf_decoder::container::Crc;
use subsurf_decoder::push::{Piece, PushReader};
use subsurf_decoder::{File, ReadError, Section};

/// What chunks a file comes in.
pub(crate) const CHUNKS: [usize; 7] = [1, 2, 3, 7, 64, 1000, usize::MAX];

/// What came of a file: pieces as text, and rows by section.
#[derive(Debug, Default, PartialEq)]
pub(crate) struct Seen {
    pub(crate) pieces: Vec<String>,
    pub(crate) rows: Vec<(Section, Vec<Vec<u8>>)>,
}

impl Seen {
    pub(crate) fn take(&mut self, piece: Piece<'_>) {
        self.pieces.push(format!("{piece:?}"));
        let Piece::Row(row) = piece else { return };
        if self.rows.last().is_none_or(|(section, _)| *section != row.section) {
            self.rows.push((row.section, vec![]));
        }
        let (_, rows) = self.rows.last_mut().unwrap();
        assert_eq!(row.number as usize, rows.len(), "rows of {} are numbered", row.section);
        rows.push(row.bytes.to_vec());
    }

    /// Rows of a section.
    pub(crate) fn of(&self, section: Section) -> &[Vec<u8>] {
        self.rows.iter().find(|(of, _)| *of == section).map_or(&[], |(_, rows)| rows)
    }
}

/// Whether results are the same; NaN is.
pub(crate) fn is_same(found: Result<(), ReadError>, expected: Result<(), ReadError>) -> bool {
    found == expected || format!("{found:?}") == format!("{expected:?}")
}

/// Pushes a file in chunks.
pub(crate) fn push<const N: usize>(bytes: &[u8], chunk: usize, crc: Crc) -> (Seen, Result<(), ReadError>) {
    let (mut seen, mut reader) = (Seen::default(), PushReader::<N>::with_crc(crc));
    for chunk in bytes.chunks(chunk.min(bytes.len().max(1))) {
        if let Err(error) = reader.push(chunk, |piece| seen.take(piece)) {
            assert!(!reader.is_complete(), "it has failed");
            let again = [reader.push(b"more", |_| panic!("nothing more")), reader.finish()];
            assert!(again.iter().all(|again| is_same(*again, Err(error))), "it stays so: {again:?}");
            return (seen, Err(error));
        }
    }
    let is_complete = reader.is_complete();
    let end = reader.finish();
    assert_eq!(end.is_ok(), is_complete, "{end:?}");
    (seen, end)
}

/// Result of a file pushed in chunks, which must be the same for all.
pub(crate) fn result(bytes: &[u8], crc: Crc) -> Result<(), ReadError> {
    let (_, whole) = push::<4096>(bytes, usize::MAX, crc);
    let (_, small) = push::<4096>(bytes, 7, crc);
    assert!(is_same(whole, small), "chunks make no difference: {whole:?}, {small:?}");
    whole
}

/// The example with a separable basis: L = 1, A = 2.
pub(crate) fn basis() -> Vec<u8> {
    let numbers = [0.5_f32, 2.0].into_iter().chain((0..12_u8).map(|k| f32::from(k) - 4.0));
    let section = [1, 2, 0, 0].into_iter().chain(numbers.flat_map(f32::to_le_bytes));
    let mut file = super::with_section(b"sepb", &section.collect::<Vec<_>>());
    super::seal_all(&mut file, 5);
    file
}

/// Vectors, BTFs of both models, and a basis, by name.
pub(crate) fn files() -> Vec<(String, Vec<u8>)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../tests/vectors");
    let vectors = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    let vectors = vectors.filter(|path| path.extension().is_some_and(|extension| extension == "subsurf"));
    let vectors =
        vectors.map(|path| (path.file_name().unwrap().to_str().unwrap().to_owned(), std::fs::read(path).unwrap()));
    let made = [("nested", super::btf::nested()), ("factored", super::btf::factored()), ("basis", basis())];
    let files: Vec<_> = vectors.chain(made.map(|(name, bytes)| (name.to_owned(), bytes))).collect();
    assert!(files.len() > 40, "vectors are at {folder}");
    files
}

/// Vector whose header follows its rows.
pub(crate) const OTHER_ORDER: &str = "other_order.subsurf";

/// Files that both readers take.
pub(crate) fn sound_files() -> impl Iterator<Item = (String, Vec<u8>)> {
    files().into_iter().filter(|(name, bytes)| File::parse(bytes).is_ok() && name != OTHER_ORDER)
}
