//! Warnings: what is left out of an input or changed in it, a line each on stderr.

use std::collections::BTreeSet;
use std::sync::{Mutex, PoisonError};

/// What was said already.
static SAID: Mutex<BTreeSet<String>> = Mutex::new(BTreeSet::new());

/// Prints a warning in one line, once in a run of the program.
pub fn warn(message: &str) {
    let is_new = SAID.lock().unwrap_or_else(PoisonError::into_inner).insert(message.to_owned());
    if is_new {
        eprintln!("{}: warning: {}", super::name(), message.replace('\n', " "));
    }
}
