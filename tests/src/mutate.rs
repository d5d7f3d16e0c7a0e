//! Broken files: mutations of whole ones, and what a reader makes of them.

use std::fmt::Display;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::time::{Duration, Instant};

use rayon::prelude::*;

/// Mutations of each kind of file, unless the environment variable `SUBSURF_MUTATIONS` says how many.
const USUAL: usize = 1_000;
/// No file of a few kilobytes may keep a reader busy for longer.
const LONGEST: Duration = Duration::from_secs(10);
/// Longest message that still is one line to read.
const MESSAGE_CHARS: usize = 400;

/// How a reader took mutated files.
#[derive(Clone, Copy, Debug, Default)]
pub struct Tally {
    /// Files that were read.
    pub read: usize,
    /// Files that were refused.
    pub refused: usize,
}

/// Has `read` read mutations of the files `whole`, each written under the name `name`.
///
/// # Panics
/// If the reader panics, takes more than ten seconds, or gives a message of several lines; if it refuses a file that is
/// whole; if it refuses no mutation. The file of the failure is kept, and its path is in the message.
pub fn assert_survives<T, E: Display>(
    name: &str,
    whole: &[Vec<u8>],
    read: impl Fn(&Path) -> Result<T, E> + Sync,
) -> Tally {
    let folder = tempfile::tempdir().expect("temporary folders can be made");
    for (k, file) in whole.iter().enumerate() {
        let message = attempt(folder.path(), &format!("whole{k}"), name, file, &read);
        assert!(message.is_none(), "{name}: whole file {k} is refused: {message:?}");
    }
    let count = std::env::var("SUBSURF_MUTATIONS").ok().and_then(|count| count.parse().ok()).unwrap_or(USUAL);
    let refused = (0..count)
        .into_par_iter()
        .filter(|&k| {
            let file = mutation(&whole[k % whole.len()], k as u64);
            attempt(folder.path(), &k.to_string(), name, &file, &read).is_some()
        })
        .count();
    assert!(refused > 0, "{name}: no mutation is refused");
    Tally { read: count - refused, refused }
}

/// Writes a file into a folder of its own, reads it, and returns what the reader says against it.
fn attempt<T, E: Display>(
    folder: &Path,
    of: &str,
    name: &str,
    file: &[u8],
    read: &impl Fn(&Path) -> Result<T, E>,
) -> Option<String> {
    let folder = folder.join(of);
    std::fs::create_dir(&folder).expect("a temporary folder can be written to");
    let path = folder.join(name);
    std::fs::write(&path, file).expect("a temporary folder can be written to");
    let start = Instant::now();
    let result = catch_unwind(AssertUnwindSafe(|| read(&path).map(drop).map_err(|error| error.to_string())));
    let took = start.elapsed();
    let verdict = match &result {
        Err(_) => Some("the reader panicked".to_owned()),
        Ok(_) if took > LONGEST => Some(format!("the reader took {} s", took.as_secs())),
        Ok(Err(message)) if message.lines().count() != 1 || message.chars().count() > MESSAGE_CHARS => {
            Some(format!("not a message of one line: {message}"))
        }
        Ok(_) => None,
    };
    if let Some(verdict) = verdict {
        let kept = std::env::temp_dir().join(format!("mutation-{of}-{name}"));
        std::fs::copy(&path, &kept).expect("temporary files can be written");
        panic!("{verdict}: {}", kept.display());
    }
    std::fs::remove_dir_all(&folder).expect("the folder is this attempt's own");
    result.expect("panics were judged").err()
}

/// Mutation number `seed` of a file: one to four changes, each of a byte, of a bit, of a run of bytes, or of a number
/// written in digits; or the file cut short, or with a piece of itself elsewhere.
#[must_use]
pub fn mutation(whole: &[u8], seed: u64) -> Vec<u8> {
    let mut file = whole.to_vec();
    let mut draw = Draw(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d_4c95_7f2d);
    for _ in 0..=draw.below(4) {
        if file.is_empty() {
            break;
        }
        // Headers are short and decide most: half of the changes are near the beginning.
        let reach = if draw.below(2) == 0 { file.len() } else { file.len().min(256) };
        let at = draw.below(reach);
        let run = 1 + draw.below(8.min(file.len() - at));
        match draw.below(8) {
            0 => file[at] = draw.byte(),
            1 => file[at] ^= 1 << draw.below(8),
            2 => file[at..at + run].fill([0x00, 0xff, 0x7f, 0x80][draw.below(4)]),
            3 => file.truncate(at),
            4 => drop(file.drain(at..at + run)),
            5 => {
                let from = draw.below(file.len());
                let piece = file[from..file.len().min(from + 1 + draw.below(64))].to_vec();
                drop(file.splice(at..at, piece));
            }
            6 => {
                let numbers: [&[u8]; 8] =
                    [b"-1", b"0", b"nan", b"1e39", b"4294967296", b"18446744073709551615", b"", b"\xe9\n"];
                drop(file.splice(at..at + run, numbers[draw.below(numbers.len())].to_vec()));
            }
            _ => {
                if let Some(digit) = (at..file.len()).find(|&at| file[at].is_ascii_digit()) {
                    file[digit] = b'0' + u8::try_from(draw.below(10)).expect("a digit");
                }
            }
        }
    }
    file
}

/// Draws of a generator (xorshift64*).
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, n: usize) -> usize {
        usize::try_from(self.next() >> 33).expect("31 bits") % n
    }

    fn byte(&mut self) -> u8 {
        self.next().to_be_bytes()[0]
    }
}
