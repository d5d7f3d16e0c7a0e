//! A height field that repeats, and rays on it. Lengths are in texels.

use glam::Vec3;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;

use super::reflectance::Finish;
use crate::math::parallel;

/// A relief and what it is made of.
pub(super) struct Relief {
    side: usize,
    heights: Vec<f32>,
    lowest: f32,
    highest: f32,
    finishes: Vec<Finish>,
    normals: Vec<Vec3>,
}

/// Which texels lie in a texel's cosine-distributed directions; those that lead to the sky are none.
pub(super) type Exchange = Vec<[u32; DIRECTIONS]>;

/// Directions in which a texel looks for light from others.
pub(super) const DIRECTIONS: usize = 24;
/// Number that stands for the sky instead of a texel.
pub(super) const SKY: u32 = u32::MAX;

/// Longest step along a ray over the plane; heights are linear in between.
const STEP: f32 = 0.5;

impl Relief {
    /// Heights and finishes row by row, `side` to a row.
    pub(super) fn new(side: usize, heights: Vec<f32>, finishes: Vec<Finish>) -> Self {
        let lowest = heights.iter().copied().fold(f32::INFINITY, f32::min);
        let highest = heights.iter().copied().fold(f32::NEG_INFINITY, f32::max);
        let at = |x: usize, y: usize| heights[(y % side) * side + x % side];
        let normal = |k: usize| {
            let (x, y) = (k % side, k / side);
            let dx = 0.5 * (at(x + 1, y) - at(x + side - 1, y));
            let dy = 0.5 * (at(x, y + 1) - at(x, y + side - 1));
            Vec3::new(-dx, -dy, 1.0).normalize()
        };
        let normals = (0..side * side).map(normal).collect();
        Self { side, heights, lowest, highest, finishes, normals }
    }

    pub(super) fn len(&self) -> usize {
        self.heights.len()
    }

    pub(super) fn finish(&self, texel: u32) -> &Finish {
        &self.finishes[texel as usize]
    }

    pub(super) fn normal(&self, texel: u32) -> Vec3 {
        self.normals[texel as usize]
    }

    /// The texel that a place over the plane lies in; its middle is at half a texel.
    #[allow(clippy::cast_possible_truncation, reason = "a few relief widths")]
    fn texel_at(&self, x: f32, y: f32) -> u32 {
        let side = self.side as i64;
        let wrap = |value: f32| (value.floor() as i64).rem_euclid(side);
        (wrap(y) * side + wrap(x)) as u32
    }

    /// Linear between the middles of texels.
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "wrapped")]
    fn height_at(&self, x: f32, y: f32) -> f32 {
        let (x, y) = (x - 0.5, y - 0.5);
        let (fx, fy) = (x - x.floor(), y - y.floor());
        let side = self.side as i64;
        let wrap = |value: i64| value.rem_euclid(side) as usize;
        let (i, j) = (x.floor() as i64, y.floor() as i64);
        let row = |j: i64| {
            let row = wrap(j) * self.side;
            let (a, b) = (self.heights[row + wrap(i)], self.heights[row + wrap(i + 1)]);
            a + fx * (b - a)
        };
        let (a, b) = (row(j), row(j + 1));
        a + fy * (b - a)
    }

    fn middle(&self, texel: usize) -> Vec3 {
        let (x, y) = ((texel % self.side) as f32 + 0.5, (texel / self.side) as f32 + 0.5);
        Vec3::new(x, y, self.heights[texel])
    }

    /// What is seen of the relief from far away, through the middle of every texel of the plane at height 0: images from all
    /// sides lie on each other. The texel in which each ray ends.
    pub(super) fn seen_from(&self, towards_eye: Vec3) -> Vec<u32> {
        let hit = |texel: usize| {
            let plane = self.middle(texel).with_z(0.0);
            let begin = plane + towards_eye * (self.highest / towards_eye.z);
            let depth = (self.highest - self.lowest) / towards_eye.z;
            let end = self.first_below(begin, -towards_eye, depth).unwrap_or(depth);
            let place = begin - end * towards_eye;
            self.texel_at(place.x, place.y)
        };
        parallel::map(self.len(), hit)
    }

    /// How far along a ray the relief is first above it, within `length`.
    fn first_below(&self, begin: Vec3, direction: Vec3, length: f32) -> Option<f32> {
        let across = direction.truncate().length();
        let count = (length * across / STEP).ceil().max(1.0);
        let step = length / count;
        let above = |t: f32| {
            let at = begin + t * direction;
            at.z - self.height_at(at.x, at.y)
        };
        let (mut t, mut before) = (0.0, above(0.0));
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few hundred")]
        for _ in 0..count as u32 {
            let after = above(t + step);
            if after < 0.0 {
                // Linear in between.
                return Some(t + step * (before / (before - after)).clamp(0.0, 1.0));
            }
            (t, before) = (t + step, after);
        }
        None
    }

    /// Whether light from a direction reaches a texel.
    pub(super) fn is_lit(&self, texel: usize, towards: Vec3) -> bool {
        self.normals[texel].dot(towards) > 0.0 && self.first_from(texel, towards).is_none()
    }

    /// How far a texel sees in a direction.
    fn first_from(&self, texel: usize, towards: Vec3) -> Option<f32> {
        // Clear of the texel's own slope.
        let begin = self.middle(texel) + 0.75 * self.normals[texel];
        let length = (self.highest - begin.z) / towards.z.max(0.02);
        if length <= 0.0 { None } else { self.first_below(begin, towards, length) }
    }

    /// Where every texel finds light of others.
    pub(super) fn exchange(&self) -> Exchange {
        let look = |texel: usize| {
            let mut rng = Pcg64::seed_from_u64(texel as u64);
            let normal = self.normals[texel];
            let (along, across) = normal.any_orthonormal_pair();
            let turn: f32 = rng.random_range(0.0..1.0);
            std::array::from_fn(|k| {
                // Cosine-distributed: sin² θ evenly spread, azimuths by the golden ratio.
                let sin2 = (k as f32 + 0.5) / DIRECTIONS as f32;
                let phi = std::f32::consts::TAU * (turn + 0.618_034 * k as f32).fract();
                let towards = sin2.sqrt() * (phi.cos() * along + phi.sin() * across) + (1.0 - sin2).sqrt() * normal;
                match self.first_from(texel, towards) {
                    Some(far) => {
                        let place = self.middle(texel) + 0.75 * normal + far * towards;
                        self.texel_at(place.x, place.y)
                    }
                    None => SKY,
                }
            })
        };
        parallel::map(self.len(), look)
    }
}
