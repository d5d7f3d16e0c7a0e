//! Interruptions: Ctrl-C and polite requests to end.

use std::sync::atomic::{AtomicU8, Ordering};

/// As shells have it: 128 and the signal's number.
pub(super) const INTERRUPTED: u8 = 130;

/// An interruption ends the program at once.
const AT_ONCE: u8 = 0;
/// The first one is for the work at hand to see.
const GRACEFULLY: u8 = 1;
/// The interruption has come.
const CAME: u8 = 2;

static STATE: AtomicU8 = AtomicU8::new(AT_ONCE);

/// Leaves no half files behind from now on.
pub(super) fn watch() {
    let handler = ctrlc::set_handler(|| {
        if STATE.compare_exchange(GRACEFULLY, CAME, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
            let name = super::name();
            eprintln!("{name}: interrupted; the best fit so far will be written. Once more to end at once");
            return;
        }
        subsurf_encoder::remove_unfinished();
        eprintln!("{}: interrupted; no half files are left", super::name());
        std::process::exit(INTERRUPTED.into());
    });
    if let Err(error) = handler {
        // Without it an interrupted run leaves a hidden temporary file behind, nothing worse.
        eprintln!("{}: cannot watch for interruptions: {error}", super::name());
    }
}

/// Guard: while it lives, the first interruption is left to those who ask [`came`], so that a fit can be ended early.
pub struct Graceful(());

impl Graceful {
    /// Starts now.
    #[allow(clippy::new_without_default, reason = "it changes what the process does")]
    pub fn new() -> Self {
        STATE.store(GRACEFULLY, Ordering::Relaxed);
        Self(())
    }
}

impl Drop for Graceful {
    fn drop(&mut self) {
        // An interruption that came is remembered: it decides about the exit code.
        STATE.compare_exchange(GRACEFULLY, AT_ONCE, Ordering::Relaxed, Ordering::Relaxed).ok();
    }
}

/// Whether there was an interruption that was left to the work at hand.
pub fn came() -> bool {
    STATE.load(Ordering::Relaxed) == CAME
}
