//! Times, their medians and quantiles.

use std::time::Instant;

/// Median of values; 0 of none.
pub(crate) fn median(values: &[f64]) -> f64 {
    quantile(values, 0.5)
}

/// Quantile: the value that this share of all is not above, linear between two of them; 0 of none.
pub(crate) fn quantile(values: &[f64], share: f64) -> f64 {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    #[allow(clippy::cast_precision_loss, reason = "small")]
    let place = share * sorted.len().saturating_sub(1) as f64;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a place among them")]
    let below = place as usize;
    let at = |k: usize| sorted.get(k).or(sorted.last()).copied().unwrap_or(0.0);
    at(below) + place.fract() * (at(below + 1) - at(below))
}

/// Clock of microseconds from lap to lap.
pub(crate) struct Clock(Instant);

impl Clock {
    /// A clock that starts now.
    pub(crate) fn new() -> Self {
        Self(Instant::now())
    }

    /// Microseconds since the last lap.
    pub(crate) fn lap(&mut self) -> f64 {
        let now = Instant::now();
        let lap = now.duration_since(self.0).as_secs_f64() * 1e6;
        self.0 = now;
        lap
    }
}

/// Time for people, from microseconds.
pub(crate) fn micros(us: f64) -> String {
    match us {
        us if us >= 1e6 => format!("{:.2} s", us / 1e6),
        us if us >= 1e3 => format!("{:.2} ms", us / 1e3),
        us => format!("{us:.1} µs"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quantiles_lie_between_values() {
        assert!(median(&[]).abs() < 1e-12);
        assert!((median(&[3.0]) - 3.0).abs() < 1e-12);
        assert!((median(&[4.0, 1.0, 2.0]) - 2.0).abs() < 1e-12);
        assert!((median(&[4.0, 1.0, 2.0, 3.0]) - 2.5).abs() < 1e-12);
        assert!((quantile(&[5.0, 1.0, 2.0, 3.0, 4.0], 0.95) - 4.8).abs() < 1e-12);
    }
}
