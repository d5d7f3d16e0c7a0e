//! Progress bars with an estimate of what is left, on stderr, when someone looks; and warnings.

use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressStyle};

use super::{interrupt, warnings};

/// Progress bars on stderr, one after the other, a stage each.
pub struct Bars(Mutex<ProgressBar>);

impl Bars {
    #[allow(clippy::new_without_default, reason = "a stage has to begin before there is a bar")]
    /// Nothing is shown until a stage begins.
    pub fn new() -> Self {
        Self(Mutex::new(ProgressBar::hidden()))
    }

    fn current(&self) -> ProgressBar {
        self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone()
    }
}

impl Drop for Bars {
    fn drop(&mut self) {
        self.current().finish_and_clear();
    }
}

impl subsurf_encoder::Progress for Bars {
    fn begin(&self, stage: &str, total: u64) {
        let template = "{msg:28} {wide_bar:.cyan/dim} {percent:>3} % {elapsed} (left: {eta})";
        let style = ProgressStyle::with_template(template).unwrap_or_else(|_| ProgressStyle::default_bar());
        let bar = ProgressBar::new(total).with_style(style).with_message(stage.to_owned());
        bar.enable_steady_tick(Duration::from_millis(250));
        let mut current = self.0.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        current.finish_and_clear();
        *current = bar;
    }

    fn advance(&self, steps: u64) {
        self.current().inc(steps);
    }

    fn warn(&self, message: &str) {
        self.current().suspend(|| warnings::warn(message));
    }

    fn stopped(&self) -> bool {
        interrupt::came()
    }
}
