//! Chances of roulette: a packet ends, or goes on that much heavier.

use std::f64::consts::FRAC_1_SQRT_2;

/// Chance to survive where a packet weighs little, as in MCML.
pub(super) const LIGHT: f64 = 0.1;

/// Events after which a packet plays whatever it weighs, and again whenever they have doubled: without absorption it would wander
/// on and on.
pub(super) const EVENTS: u32 = 1 << 14;

/// Chance to survive after so many events: 1/√2 of the packets come twice as far, so that survivors neither cost more and more nor
/// grow too heavy.
pub(super) const LATE: f64 = FRAC_1_SQRT_2;
