//! What readers warn of.

use std::sync::Mutex;

use subsurf_encoder::Progress;

/// Keeps the warnings that a reader gives.
#[derive(Default)]
pub(crate) struct Warnings(Mutex<Vec<String>>);

impl Warnings {
    pub(crate) fn into_lines(self) -> Vec<String> {
        self.0.into_inner().expect("no reader panicked")
    }
}

impl Progress for Warnings {
    fn begin(&self, _: &str, _: u64) {}
    fn advance(&self, _: u64) {}
    fn warn(&self, message: &str) {
        self.0.lock().expect("no reader panicked").push(message.to_owned());
    }
}
