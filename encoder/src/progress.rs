//! Progress of long work, warnings of its input, and requests to end it early.

/// Receives progress of work that takes longer than a second.
pub trait Progress: Sync {
    /// A stage of `total` steps begins; the one before it is over.
    fn begin(&self, stage: &str, total: u64);
    /// `steps` more of the current stage are done.
    fn advance(&self, steps: u64);
    /// What is left out of an input or changed in it, in one line with a count; the same may be said twice.
    fn warn(&self, _: &str) {}
    /// Whether to make do with what there is: work that gets better step by step then ends early, and says so.
    fn stopped(&self) -> bool {
        false
    }
}

/// Silence: nothing is reported, and nothing is stopped.
impl Progress for () {
    fn begin(&self, _: &str, _: u64) {}
    fn advance(&self, _: u64) {}
}
