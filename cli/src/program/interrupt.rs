//! Interruptions: Ctrl-C and polite requests to end.

use std::sync::atomic::{AtomicU8, Ordering};
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// As shells have it: 128 and the signal's number.
pub(super) const INTERRUPTED: u8 = 130;

/// An interruption ends the program at once.
const AT_ONCE: u8 = 0;
/// The first one is for the work at hand to see.
const GRACEFULLY: u8 = 1;
/// The interruption has come.
const CAME: u8 = 2;

static STATE: AtomicU8 = AtomicU8::new(AT_ONCE);

/// Longest time that the last words may take: who should read them may not.
const LAST_WORDS: Duration = Duration::from_millis(200);

/// Leaves no half files behind from now on.
pub(super) fn watch() {
    if let Err(error) = signals::watch() {
        // Without it an interrupted run leaves a hidden temporary file behind, nothing worse.
        eprintln!("{}: cannot watch for interruptions: {error}", super::name());
    }
}

/// What Ctrl-C does: the first one is left to work that wants to know, any other ends the program.
fn interrupt() {
    if STATE.compare_exchange(GRACEFULLY, CAME, Ordering::Relaxed, Ordering::Relaxed).is_ok() {
        say("interrupted; what there is so far will be written. Once more to end at once");
    } else {
        end("interrupted");
    }
}

/// Ends the program at once, wherever its other threads are: destructors of graphics drivers are not waited for.
fn end(why: &str) {
    subsurf_encoder::remove_unfinished();
    say(&format!("{why}; no half files are left"));
    signals::exit(INTERRUPTED.into());
}

/// Prints a line on stderr, or gives up: another thread may hold it, and nobody may read.
fn say(message: &str) {
    let line = format!("{}: {message}", super::name());
    let (said, heard) = mpsc::channel();
    thread::spawn(move || {
        eprintln!("{line}");
        // Nobody may wait any more.
        said.send(()).ok();
    });
    heard.recv_timeout(LAST_WORDS).ok();
}

#[cfg(unix)]
mod signals {
    use std::io;
    use std::thread;

    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    use signal_hook::iterator::Signals;

    pub(super) use signal_hook::low_level::exit;

    pub(super) fn watch() -> io::Result<()> {
        let mut signals = Signals::new([SIGINT, SIGTERM, SIGHUP])?;
        thread::Builder::new().name("signals".to_owned()).spawn(move || {
            for signal in signals.forever() {
                if signal == SIGINT { super::interrupt() } else { super::end("terminated") }
            }
        })?;
        Ok(())
    }
}

#[cfg(not(unix))]
mod signals {
    pub(super) use std::process::exit;

    pub(super) fn watch() -> Result<(), ctrlc::Error> {
        ctrlc::set_handler(super::interrupt)
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
