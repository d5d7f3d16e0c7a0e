//! Many packets side by side in a homogeneous half-space: loops over arrays that a compiler makes vector instructions of.
//!
//! The way of every packet is that of the plain loop in `packet`, in units of the mean free path and in single precision. All
//! packets hop and turn at once; those few that come to the surface are looked at one by one. A packet has random numbers of
//! its own, so neither the number of lanes nor the processor's vectors change a result.

use std::array;
use std::f32::consts::PI;

/// Packets side by side: vectors of four processors out of five divide this.
pub(super) const LANES: usize = 16;

type Floats = [f32; LANES];

/// Packets on their way.
#[derive(Clone, Copy)]
pub(super) struct Lanes {
    /// Positions in mean free paths.
    pub(super) position: [Floats; 3],
    pub(super) direction: [Floats; 3],
    /// Collisions so far.
    pub(super) collisions: [u32; LANES],
    /// Collisions at which a packet plays roulette next, at most [`NEVER`].
    pub(super) roulette_at: [u32; LANES],
    /// Depths in mean free paths at which a packet plays roulette next.
    pub(super) roulette_below: Floats,
    /// What roulettes that were survived multiply weights by.
    pub(super) factor: Floats,
    pub(super) state: [[u32; LANES]; 4],
    /// Words whose sign bits tell which packets came above the surface, or to roulette.
    pub(super) signs: [u32; LANES],
}

/// More collisions than a packet has.
pub(super) const NEVER: u32 = i32::MAX as u32;

impl Lanes {
    pub(super) fn new() -> Self {
        Self {
            position: [[0.0; LANES]; 3],
            direction: [[0.0; LANES]; 3],
            collisions: [0; LANES],
            roulette_at: [NEVER; LANES],
            roulette_below: [0.0; LANES],
            factor: [1.0; LANES],
            state: [[0; LANES]; 4],
            signs: [0; LANES],
        }
    }

    /// The packet of another lane.
    pub(super) fn take(&mut self, lane: usize, from: &Self, at: usize) {
        let floats =
            self.position.iter_mut().chain(&mut self.direction).zip(from.position.iter().chain(&from.direction));
        floats.for_each(|(all, from)| all[lane] = from[at]);
        self.state.iter_mut().zip(&from.state).for_each(|(all, from)| all[lane] = from[at]);
        self.collisions[lane] = from.collisions[at];
        self.roulette_at[lane] = from.roulette_at[at];
        self.roulette_below[lane] = from.roulette_below[at];
        self.factor[lane] = from.factor[at];
    }

    /// A new packet in a lane, which goes straight down and comes to its first collision.
    pub(super) fn start(&mut self, lane: usize, seed: u64) {
        // Vigna's splitmix64 fills the state, so that neighbouring seeds have nothing in common.
        let mut seed = seed;
        let mut word = || {
            seed = seed.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mixed = (seed ^ (seed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            mixed ^ (mixed >> 31)
        };
        #[allow(clippy::cast_possible_truncation, reason = "halves of a word")]
        let halves = |word: u64| [word as u32, (word >> 32) as u32];
        let [a, b] = [word(), word()].map(halves);
        for (state, word) in self.state.iter_mut().zip([a[0], a[1], b[0], b[1]]) {
            state[lane] = word;
        }
        let depth = -ln(open_unit(self.random(lane)));
        for axis in 0..3 {
            self.position[axis][lane] = if axis == 2 { depth } else { 0.0 };
            self.direction[axis][lane] = if axis == 2 { 1.0 } else { 0.0 };
        }
        self.collisions[lane] = 0;
        self.factor[lane] = 1.0;
    }

    /// Lanes below `alive` whose packets are flagged by `signs`, the last first: the packet of the last lane may move into an emptied one.
    pub(super) fn flagged(&self, alive: usize) -> impl Iterator<Item = usize> + use<> {
        let flags = self.signs.iter().enumerate().fold(0, |flags, (lane, signs)| flags | (signs >> 31) << lane);
        let mut flags = flags & !(u32::MAX << LANES.min(alive));
        std::iter::from_fn(move || {
            let lane = flags.checked_ilog2()?;
            flags ^= 1 << lane;
            Some(lane as usize)
        })
    }

    /// Roulette: a packet goes on that much heavier with a chance of `survival`, or ends. Whether it ended.
    pub(super) fn play(&mut self, lane: usize, survival: f64) -> bool {
        #[allow(clippy::cast_possible_truncation, reason = "lanes are of single precision")]
        let survival = survival as f32;
        self.factor[lane] /= survival;
        self.uniform(lane) >= survival
    }

    /// A random number of a lane's packet, in 0 .. 1.
    pub(super) fn uniform(&mut self, lane: usize) -> f32 {
        unit(self.random(lane))
    }

    fn random(&mut self, lane: usize) -> u32 {
        let mut state = array::from_fn(|k| self.state[k][lane]);
        let word = next(&mut state);
        for (all, one) in self.state.iter_mut().zip(state) {
            all[lane] = one;
        }
        word
    }

    /// Counts the collisions that all packets have come to, turns them, and makes their next hops: s = −ln ξ along the new
    /// direction. Positions above the surface are for the caller to mend. Whether any packet came above it, or to roulette:
    /// `signs` say which.
    #[inline(always)]
    pub(super) fn turn_and_hop<const ISOTROPIC: bool>(&mut self, phase: Phase) -> bool {
        let mut any = 0;
        for lane in 0..LANES {
            let mut state = array::from_fn(|k| self.state[k][lane]);
            let [first, second, third] = [next(&mut state), next(&mut state), next(&mut state)];
            let (xi, turn) = (unit(first), unit(second));
            let u = match ISOTROPIC {
                true => isotropic(xi, turn),
                false => phase.turn(array::from_fn(|axis| self.direction[axis][lane]), xi, turn),
            };
            let s = -ln(open_unit(third));
            for axis in 0..3 {
                self.direction[axis][lane] = u[axis];
                self.position[axis][lane] += s * u[axis];
            }
            for k in 0..4 {
                self.state[k][lane] = state[k];
            }
            self.collisions[lane] += 1;
            let left = self.roulette_at[lane].wrapping_sub(1).wrapping_sub(self.collisions[lane]);
            let z = self.position[2][lane];
            // Sign bits: of depths, and of what is left until roulette.
            let signs = z.to_bits() | (self.roulette_below[lane] - z).to_bits() | left;
            self.signs[lane] = signs;
            any |= signs;
        }
        any >> 31 != 0
    }
}

/// How packets turn.
#[derive(Clone, Copy)]
pub(super) struct Phase {
    /// Mean cosine g.
    pub(super) g: f32,
}

impl Phase {
    /// Whether g is taken for 0: of a smaller one, differences in [`Self::turn`] would lose all digits.
    pub(super) fn is_isotropic(self) -> bool {
        self.g.abs() < 1e-4
    }

    /// A direction about `u` by Henyey and Greenstein, from two random numbers in 0 .. 1.
    #[inline(always)]
    fn turn(self, u: [f32; 3], xi: f32, turn: f32) -> [f32; 3] {
        let (sin_phi, cos_phi) = sin_cos_of_turn(turn);
        let g = self.g;
        // 1 − cos θ = (1 − g) (1 + g)² ... in factors: near 1 the difference would lose all its digits.
        let below = 1.0 - g + 2.0 * g * xi;
        let ratio = (1.0 - g * g) / below;
        let one_minus = positive((ratio - (1.0 - g)) * (ratio + (1.0 - g)) / (2.0 * g));
        let cosine = 1.0 - one_minus;
        let sine = positive(one_minus * (2.0 - one_minus)).sqrt();
        let [ux, uy, uz] = u;
        // Straight up or down there is no direction across: any will do.
        let ux = if ux * ux + uy * uy < 1e-18 { 1e-9 } else { ux };
        let across2 = ux * ux + uy * uy;
        let across = across2.sqrt();
        let (p, q) = (sine * cos_phi, sine * sin_phi);
        let new = [
            (ux * uz * p - uy * q) / across + ux * cosine,
            (uy * uz * p + ux * q) / across + uy * cosine,
            -p * across + uz * cosine,
        ];
        // One step of Newton's towards length 1.
        let scale = 1.5 - 0.5 * (new[0] * new[0] + new[1] * new[1] + new[2] * new[2]);
        new.map(|x| x * scale)
    }
}

/// A direction on all sides alike, from two random numbers in 0 .. 1.
#[inline(always)]
pub(super) fn isotropic(xi: f32, turn: f32) -> [f32; 3] {
    let (sin_phi, cos_phi) = sin_cos_of_turn(turn);
    let cosine = 2.0 * xi - 1.0;
    let sine = positive(1.0 - cosine * cosine).sqrt();
    [sine * cos_phi, sine * sin_phi, cosine]
}

/// The next number of Blackman and Vigna's xoshiro128+.
#[inline(always)]
pub(super) fn next(state: &mut [u32; 4]) -> u32 {
    let result = state[0].wrapping_add(state[3]);
    let shifted = state[1] << 9;
    state[2] ^= state[0];
    state[3] ^= state[1];
    state[1] ^= state[2];
    state[0] ^= state[3];
    state[2] ^= shifted;
    state[3] = state[3].rotate_left(11);
    result
}

/// 0 to 1, 1 excluded, from the upper 24 bits: the lower ones of xoshiro128+ are weak.
#[inline(always)]
pub(super) fn unit(word: u32) -> f32 {
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_wrap, reason = "24 bits are exact")]
    let upper = (word >> 8) as i32 as f32;
    upper * (1.0 / 16_777_216.0)
}

/// 0 excluded to 1, from 31 bits: 24 would end hops at 16.6 mean free paths.
#[inline(always)]
pub(super) fn open_unit(word: u32) -> f32 {
    #[allow(clippy::cast_precision_loss, clippy::cast_possible_wrap, reason = "rounding is even over the range")]
    let upper = (word >> 1) as i32 as f32;
    (upper + 0.5) * (1.0 / 2_147_483_648.0)
}

/// ln x of a positive, normal x: m 2^e with m about 1, and ln m = 2 artanh((m − 1) / (m + 1)).
#[inline(always)]
pub(super) fn ln(x: f32) -> f32 {
    const SQRT_HALF: u32 = 0x3f35_04f3;
    let bits = x.to_bits().wrapping_sub(SQRT_HALF);
    #[allow(clippy::cast_possible_wrap, clippy::cast_precision_loss, reason = "exponents are small")]
    let e = ((bits as i32) >> 23) as f32;
    let m = f32::from_bits((bits & 0x007f_ffff).wrapping_add(SQRT_HALF));
    let t = (m - 1.0) / (m + 1.0);
    let t2 = t * t;
    let series = 1.0 + t2 * (1.0 / 3.0 + t2 * (1.0 / 5.0 + t2 * (1.0 / 7.0 + t2 * (1.0 / 9.0))));
    2.0 * t * series + e * std::f32::consts::LN_2
}

/// `x`, or 0 where it is below: one instruction, unlike `max`, which looks after NaN.
#[inline(always)]
pub(super) fn positive(x: f32) -> f32 {
    if x > 0.0 { x } else { 0.0 }
}

/// Sine and cosine of a turn in 0 .. 1, less π: of a quarter of it by its series, from −π/4 to π/4, and doubled twice.
#[inline(always)]
pub(super) fn sin_cos_of_turn(turn: f32) -> (f32, f32) {
    let quarter = 0.5 * PI * (turn - 0.5);
    let q2 = quarter * quarter;
    let tail = 1.0 / 120.0 + q2 * (-1.0 / 5_040.0 + q2 * (1.0 / 362_880.0));
    let sine = quarter * (1.0 + q2 * (-1.0 / 6.0 + q2 * tail));
    let cosine = (1.0 - sine * sine).sqrt();
    let (sine, cosine) = (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine);
    (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn functions_are_those_of_the_library() {
        for k in 0..100_000_u32 {
            let word = k.wrapping_mul(0x9e37_79b9);
            let x = open_unit(word);
            assert!((f64::from(ln(x)) - f64::from(x).ln()).abs() < 1e-6 * f64::from(1.0 - x.ln()), "ln {x}");
            let turn = unit(word);
            let phi = std::f64::consts::TAU * (f64::from(turn) - 0.5);
            let (sine, cosine) = sin_cos_of_turn(turn);
            assert!((f64::from(sine) - phi.sin()).abs() < 1e-6, "sin {phi}");
            assert!((f64::from(cosine) - phi.cos()).abs() < 1e-6, "cos {phi}");
        }
        assert!(ln(open_unit(0)) < -21.0 && ln(open_unit(u32::MAX)) <= 0.0, "ends of the range");
    }
}
