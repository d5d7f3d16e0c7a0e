//! The unknowns of the fit.

use subsurf_decoder::bssrdf::basis::{BasisSize, Cascade, WIDTHS};

/// All numbers of a basis while it is fitted.
#[derive(Clone, Debug)]
pub(super) struct Params {
    pub(super) size: BasisSize,
    /// ln σ_a of widths in pixels, shape `[A]`, rising.
    pub(super) log_sigmas: Vec<f64>,
    pub(super) channels: [Channel; 3],
}

/// Numbers of one colour channel.
#[derive(Clone, Debug, Default)]
pub(super) struct Channel {
    /// Factors of the scaled nodes, shape `[L][node]`.
    pub(super) d: Vec<f64>,
    /// Weights, shape `[pair l ≤ m][A]`.
    pub(super) w: Vec<f64>,
}

/// Least factor from one width to the next.
const LEAST_STEP: f64 = 1.15;
/// Largest factor from one width to the next, within what the format allows.
const LARGEST_STEP: f64 = 12.0;
/// Narrowest and widest of the first width in pixels, within what the format allows.
const FIRST: [f64; 2] = [0.25, 12.0];

impl Params {
    /// Widths σ_a in pixels.
    pub(super) fn sigmas(&self) -> impl Iterator<Item = f64> {
        self.log_sigmas.iter().map(|log| log.exp())
    }

    /// Blurs of the renderer by these widths.
    pub(super) fn cascade(&self) -> Cascade {
        #[allow(clippy::cast_possible_truncation, reason = "pixels, within a window")]
        Cascade::new(self.sigmas().map(|sigma| sigma as f32))
    }

    /// Brings widths into the ranges of the format, where each is wider than the one before.
    pub(super) fn keep_widths_in_range(&mut self) {
        let mut range = FIRST.map(f64::ln);
        for log in &mut self.log_sigmas {
            *log = log.max(range[0]).min(range[1]);
            range = [*log + LEAST_STEP.ln(), (*log + LARGEST_STEP.ln()).min(f64::from(WIDTHS[1]).ln())];
        }
    }

    /// Number of unknowns of one channel besides the widths.
    pub(super) fn of_channel(&self) -> usize {
        self.channels[0].d.len() + self.channels[0].w.len()
    }

    /// Adds a step: that of every channel, d then w, and that of the widths.
    pub(super) fn stepped(&self, channels: &[Vec<f64>; 3], log_sigmas: &[f64]) -> Self {
        let mut params = self.clone();
        for (channel, step) in params.channels.iter_mut().zip(channels) {
            channel.d.iter_mut().chain(&mut channel.w).zip(step).for_each(|(value, step)| *value += step);
        }
        params.log_sigmas.iter_mut().zip(log_sigmas).for_each(|(log, step)| *log += step.clamp(-0.3, 0.3));
        params.keep_widths_in_range();
        params
    }
}

impl Params {
    /// Factors of the scaled nodes for one l, shape `[node]`.
    pub(super) fn factors(&self, l: usize, c: usize) -> &[f64] {
        let d = &self.channels[c].d;
        &d[l * (d.len() / self.size.terms)..][..d.len() / self.size.terms]
    }

    /// Weight w_lma.
    pub(super) fn weight(&self, l: usize, m: usize, a: usize, c: usize) -> f64 {
        self.channels[c].w[self.size.pair(l, m) * self.size.gaussians + a]
    }
}
