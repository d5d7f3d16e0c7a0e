//! Jumps of packets through a homogeneous half-space with isotropic scattering.
//!
//! Of a packet that collides, the next that matters is where and when it comes out of a sphere about that place: on all sides alike,
//! at an angle to the normal and with a weight that [`Sphere`] knows. So it jumps to the surface of the largest sphere of a table
//! that lies in the medium, and walks on from there; nothing is approximated but the table. Near the surface it collides and turns,
//! as a jump of no length.

use std::array;
use std::sync::OnceLock;

use super::lanes::{LANES, Lanes, ln, next, open_unit, positive, sin_cos_of_turn, unit};
use super::sphere::Sphere;
use crate::math::parallel;

/// Radii from 2^e have 1, 5/4, 6/4 and 7/4 of it: the upper bits of a depth tell the largest that fits.
const STEPS: u32 = 23 - 2;
/// Radii, from 1 to 56 mean free paths.
const RADII: usize = 24;
const SMALLEST: u32 = 1.0_f32.to_bits() >> STEPS;
const LARGEST: f32 = 56.0;
/// Equal parts of the light that leaves a sphere, of which each leaves at the mean of its cosines to the normal. They differ by less than
/// 0.01 within a part, and by up to 0.1 in the few that graze the surface.
const PARTS: usize = 1 << PART_BITS;
const PART_BITS: u32 = 8;
/// Rows of the tables: a power of two, so that no look-up has to be checked.
const ROWS: usize = 32;

/// Spheres of all radii, by their numbers from 1; 0 is no jump.
pub(super) struct Jumps {
    /// What a jump multiplies weights by; the collision at its start is counted.
    weights: [f32; ROWS],
    /// Cosines to the normal of a sphere of each part of the light.
    cosines: Box<[f32; PARTS * ROWS]>,
    /// η of the medium by that above.
    eta: f32,
    /// Weight below which a packet plays roulette.
    light: f32,
}

impl Jumps {
    /// Of a medium with that albedo σ_s / σ_t.
    pub(super) fn new(albedo: f64, eta: f64, threshold: f64) -> Self {
        // Spheres know nothing of the medium: each is made once for all runs.
        static SPHERES: [OnceLock<Sphere>; RADII] = [const { OnceLock::new() }; RADII];
        let exits = parallel::map(RADII, |k| {
            #[allow(clippy::cast_possible_truncation, reason = "radii are few")]
            let radius = f64::from(f32::from_bits((SMALLEST + k as u32) << STEPS));
            SPHERES[k].get_or_init(|| Sphere::new(radius)).solve(albedo)
        });
        #[allow(clippy::cast_possible_truncation, reason = "lanes are of single precision")]
        let single = |x: f64| x as f32;
        let mut weights = [single(albedo); ROWS];
        let mut cosines = Box::new([1.0; PARTS * ROWS]);
        for (k, exits) in exits.iter().enumerate() {
            weights[k + 1] = single(albedo * exits.share);
            exits.cosines(&mut cosines[(k + 1) * PARTS..][..PARTS]);
        }
        Self { weights, cosines, eta: single(eta), light: single(threshold) }
    }
}

impl Lanes {
    /// Jumps of all packets from their collisions, and their hops from there to the next. Those that come to the surface are reflected
    /// or stay above it. Whether any packet left, or came to roulette: `signs` say which.
    #[inline(always)]
    pub(super) fn jump_and_hop(&mut self, jumps: &Jumps) -> bool {
        let (mut radii, mut places, mut cosines) = ([0.0_f32; LANES], [0_u32; LANES], [0.0_f32; LANES]);
        for lane in 0..LANES {
            let mut state = array::from_fn(|k| self.state[k][lane]);
            let part = next(&mut state) >> (32 - PART_BITS);
            for k in 0..4 {
                self.state[k][lane] = state[k];
            }
            let depth = self.position[2][lane];
            let depth = if depth < LARGEST { depth } else { LARGEST };
            let bits = depth.to_bits();
            // Below 2^31, since depths are positive: signed comparisons are those that all processors have.
            #[allow(clippy::cast_possible_wrap, clippy::cast_sign_loss, reason = "exponents are small")]
            let number = ((bits >> STEPS) as i32 - (SMALLEST - 1) as i32).max(0) as u32;
            radii[lane] = if number > 0 { f32::from_bits(bits >> STEPS << STEPS) } else { 0.0 };
            places[lane] = number << PART_BITS | part;
        }
        for lane in 0..LANES {
            let place = places[lane] as usize;
            self.factor[lane] *= jumps.weights[place >> PART_BITS & (ROWS - 1)];
            cosines[lane] = jumps.cosines[place & (PARTS * ROWS - 1)];
        }
        let mut any = 0;
        for lane in 0..LANES {
            let mut state = array::from_fn(|k| self.state[k][lane]);
            let [first, second, third, fourth, fifth] = array::from_fn(|_| next(&mut state));
            for k in 0..4 {
                self.state[k][lane] = state[k];
            }
            // A direction d from the centre, on all sides alike, and beside it those across: ∂d/∂θ and ∂d/∂φ / sin θ.
            let down = 2.0 * unit(first) - 1.0;
            let level = positive(1.0 - down * down).sqrt();
            let (sin_phi, cos_phi) = sin_cos_of_turn(unit(second));
            // The direction at which the packet comes out of the sphere.
            let along = cosines[lane];
            let across = positive(1.0 - along * along).sqrt();
            let (sine, cosine) = sin_cos_of_turn(unit(third));
            let (theta, phi) = (across * cosine, across * sine);
            let lateral = level * along + down * theta;
            let u =
                [cos_phi * lateral - sin_phi * phi, sin_phi * lateral + cos_phi * phi, down * along - level * theta];
            let s = -ln(open_unit(fourth));
            let r = radii[lane];
            let x = self.position[0][lane] + r * level * cos_phi + s * u[0];
            let y = self.position[1][lane] + r * level * sin_phi + s * u[1];
            let mut z = self.position[2][lane] + r * down + s * u[2];
            // Fresnel's reflectance ½ (n₁/d₁ + n₂/d₂) against a random number; beyond the critical angle both quotients are 1.
            let cosine = -u[2];
            let there = positive(1.0 - jumps.eta * jumps.eta * (1.0 - cosine * cosine)).sqrt();
            let square = |x: f32| x * x;
            let n1 = square(jumps.eta * cosine - there);
            let d1 = square(jumps.eta * cosine + there);
            let n2 = square(cosine - jumps.eta * there);
            let d2 = square(cosine + jumps.eta * there);
            let reflected = 2.0 * unit(fifth) * (d1 * d2) < n1 * d2 + n2 * d1;
            // What is reflected has the rest of its hop mirrored; all directions are alike to it then.
            if reflected {
                z = z.abs();
            }
            self.position[0][lane] = x;
            self.position[1][lane] = y;
            self.position[2][lane] = z;
            for axis in 0..3 {
                self.direction[axis][lane] = u[axis];
            }
            self.collisions[lane] += 1;
            let left = self.roulette_at[lane].wrapping_sub(1).wrapping_sub(self.collisions[lane]);
            let signs = z.to_bits()
                | (self.roulette_below[lane] - z).to_bits()
                | (self.factor[lane] - jumps.light).to_bits()
                | left;
            self.signs[lane] = signs;
            any |= signs;
        }
        any >> 31 != 0
    }
}
