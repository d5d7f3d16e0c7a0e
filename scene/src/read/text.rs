//! Text of mesh files: lines, words and numbers, in whatever encoding names and comments are.

use std::borrow::Cow;

/// Text without its byte-order mark; UTF-16, as some shells write it, becomes UTF-8.
pub(super) fn without_mark(bytes: &[u8]) -> Cow<'_, [u8]> {
    let wide = |bytes: &[u8], unit: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.as_chunks().0.iter().map(|&pair| unit(pair)).collect();
        Cow::Owned(String::from_utf16_lossy(&units).into_bytes())
    };
    match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => Cow::Borrowed(rest),
        [0xff, 0xfe, rest @ ..] => wide(rest, u16::from_le_bytes),
        [0xfe, 0xff, rest @ ..] => wide(rest, u16::from_be_bytes),
        _ => Cow::Borrowed(bytes),
    }
}

/// Lines of a text and their numbers, from 1. They end as on any system.
#[derive(Clone)]
pub(super) struct Lines<'a> {
    rest: Option<&'a [u8]>,
    number: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a [u8]) -> Self {
        Self { rest: Some(text), number: 0 }
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = (usize, &'a [u8]);

    fn next(&mut self) -> Option<Self::Item> {
        let text = self.rest?;
        self.number += 1;
        let end = text.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(text.len());
        self.rest = match &text[end..] {
            [b'\r', b'\n', rest @ ..] | [_, rest @ ..] => Some(rest),
            [] => None,
        };
        Some((self.number, &text[..end]))
    }
}

/// Words of a line, up to a comment.
pub(super) fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    all_words(line).take_while(|word| !is_comment(word))
}

/// Whether a line ends with a comment.
pub(super) fn has_comment(line: &[u8]) -> bool {
    all_words(line).any(is_comment)
}

fn all_words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty())
}

/// Whether a word is the first of a comment.
fn is_comment(word: &[u8]) -> bool {
    word[0] == b'#'
}

/// A number; what C libraries print for those that are not finite is one as well.
pub(super) fn number(word: &[u8]) -> Option<f64> {
    let text = std::str::from_utf8(word).ok()?;
    text.parse().ok().or_else(|| {
        let text = text.to_ascii_lowercase();
        if text.contains("#inf") {
            return Some(f64::INFINITY);
        }
        (text.contains("#ind") || text.contains("#qnan") || text.contains("#snan") || text.contains("nan("))
            .then_some(f64::NAN)
    })
}

/// The first N words as numbers; nothing if there are fewer.
///
/// # Errors
/// The word that is no number, as a message shows it.
pub(super) fn numbers<'a, const N: usize>(
    mut words: impl Iterator<Item = &'a [u8]>,
) -> Result<Option<[f64; N]>, String> {
    let mut out = [0.0; N];
    for slot in &mut out {
        let Some(word) = words.next() else {
            return Ok(None);
        };
        *slot = number(word).ok_or_else(|| format!("{} is not a number", quoted(word)))?;
    }
    Ok(Some(out))
}

/// A word, or what else a file says, as a message quotes it: on one line, and short.
pub(super) fn quoted(word: &[u8]) -> String {
    format!("\"{}\"", shortened(&String::from_utf8_lossy(word), 60))
}

/// The first `longest` letters of a text, on one line.
pub(super) fn shortened(text: &str, longest: usize) -> String {
    let mut letters = text.chars().map(|letter| if letter.is_control() { char::REPLACEMENT_CHARACTER } else { letter });
    let mut out: String = letters.by_ref().take(longest).collect();
    if letters.next().is_some() {
        out.push('…');
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_end_as_on_any_system() {
        let lines: Vec<_> = Lines::new(b"a\nb\r\nc\rd\n\ne").collect();
        let expected: [(usize, &[u8]); 6] = [(1, b"a"), (2, b"b"), (3, b"c"), (4, b"d"), (5, b""), (6, b"e")];
        assert_eq!(lines, expected);
    }

    #[test]
    fn words_end_at_a_comment_and_numbers_are_as_printed_anywhere() {
        let words: Vec<_> = words(b"  v\t1 2  #3 4").collect();
        assert_eq!(words, [&b"v"[..], b"1", b"2"]);
        for (word, value) in
            [("1e-3", 1e-3), ("+.5", 0.5), ("2.", 2.0), ("-1.#INF", f64::INFINITY), ("inf", f64::INFINITY)]
        {
            assert_eq!(number(word.as_bytes()), Some(value), "{word}");
        }
        for word in ["nan", "-NaN", "1.#QNAN", "-1.#IND00", "-nan(ind)"] {
            assert!(number(word.as_bytes()).is_some_and(f64::is_nan), "{word}");
        }
        assert_eq!([&b"0,5"[..], b"\xe9", b""].map(number), [None; 3], "no numbers");
    }

    #[test]
    fn byte_order_marks_are_no_text() {
        assert_eq!(*without_mark(b"\xef\xbb\xbfv 1"), *b"v 1");
        assert_eq!(*without_mark(b"\xff\xfev\0 \x001\0"), *b"v 1");
        assert_eq!(*without_mark(b"\xfe\xff\0v\0 \x001"), *b"v 1");
    }
}
