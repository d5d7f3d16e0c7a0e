//! Lines of values, of a text in which `#` begins a comment and empty lines mean nothing.

use std::path::Path;
use std::str::FromStr;

use crate::error::{Error, Result, one_line};

/// Lines that are not read yet.
pub(super) struct Lines<'a> {
    path: &'a Path,
    lines: std::iter::Peekable<std::vec::IntoIter<(usize, Vec<&'a str>)>>,
}

/// Words of a line that are not read yet.
pub(super) struct Words<'a> {
    path: &'a Path,
    pub(super) number: usize,
    words: std::vec::IntoIter<&'a str>,
}

impl<'a> Lines<'a> {
    pub(super) fn new(path: &'a Path, text: &'a str) -> Self {
        let words = |line: &'a str| line.split('#').next().unwrap_or("").split_whitespace().collect::<Vec<_>>();
        let lines = text.lines().enumerate().map(|(k, line)| (k + 1, words(line)));
        let lines: Vec<_> = lines.filter(|(_, words)| !words.is_empty()).collect();
        Self { path, lines: lines.into_iter().peekable() }
    }

    /// The next line, which has `expected` in it.
    pub(super) fn next(&mut self, expected: &str) -> Result<Words<'a>> {
        let Some((number, words)) = self.lines.next() else {
            return Err(self.refuse("its end".into(), expected));
        };
        Ok(Words { path: self.path, number, words: words.into_iter() })
    }

    /// Whether nothing is left, or the next line begins with the word `end`, which is then read.
    pub(super) fn end(&mut self) -> bool {
        match self.lines.peek() {
            None => true,
            Some((_, words)) if words[0] == "end" => {
                self.lines.next();
                true
            }
            Some(_) => false,
        }
    }

    /// Goes to what follows the next line that is the one word `title`, which is called `expected`.
    pub(super) fn skip_to(&mut self, title: &str, expected: &str) -> Result<()> {
        while !self.next(expected)?.is(title) {}
        Ok(())
    }

    pub(super) fn refuse(&self, found: String, expected: &str) -> Error {
        Error::Input { path: self.path.into(), found, expected: expected.into() }
    }
}

impl<'a> Words<'a> {
    /// The next word, a value of type `T` that is called `expected`.
    pub(super) fn value<T: FromStr>(&mut self, expected: &str) -> Result<T> {
        let word = self.words.next();
        let value = word.and_then(|word| word.parse().ok());
        value.ok_or_else(|| self.refuse(word.unwrap_or("the line's end"), expected))
    }

    /// The next word as a number; C's `1E8` and Rust's agree.
    pub(super) fn number(&mut self, expected: &str) -> Result<f64> {
        self.value(expected)
    }

    pub(super) fn word(&mut self, expected: &str) -> Result<&'a str> {
        let word = self.words.next();
        word.ok_or_else(|| self.refuse("the line's end", expected))
    }

    /// Whether the line is this one word.
    fn is(mut self, word: &str) -> bool {
        self.words.next() == Some(word) && self.words.next().is_none()
    }

    /// The words that are left.
    pub(super) fn rest(self) -> impl Iterator<Item = &'a str> {
        self.words
    }

    pub(super) fn refuse(&self, found: &str, expected: &str) -> Error {
        let found = format!("{} in line {}", one_line(found), self.number);
        Error::Input { path: self.path.into(), found, expected: expected.into() }
    }
}
