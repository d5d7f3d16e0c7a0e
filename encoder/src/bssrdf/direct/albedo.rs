//! The diffuse albedo of every pixel under the current model, and how it depends on the pixel's profile.
//!
//! The cost of eq. 5 counts errors of ln Rd, of which an albedo is a sum weighted by Rd: small errors of one sign add
//! up where the cost hardly sees them, and the eye does. The last sweeps of the search therefore also weigh the
//! relative error of each pixel's albedo, linearised around the current model.

use crate::bssrdf::field::Field;
use crate::bssrdf::normal::Normal;
use crate::bssrdf::window::Geometry;
use crate::math::lanes::{Lanes, ZERO};
use crate::math::parallel;

/// √Rd of every pixel at the distance of every ring: Rd(i, j) is the product of two entries (eq. 1).
pub(super) struct Albedo {
    /// f_x(r) = exp(½ P̂_x(r)) in mm⁻¹, with one node per ring.
    roots: Field,
    deltas: Vec<isize>,
    /// w of a squared error against the cost of eq. 5.
    weight: f32,
}

/// Albedo error of one pixel as a function of its profile p relative to the mean: ε = k·p − τ per channel.
pub(super) struct Constraint {
    /// Weight w of the squared error against the cost of eq. 5.
    pub(super) weight: f32,
    /// Derivative ∂ε/∂p, `[node]`.
    pub(super) k: Vec<Lanes>,
    pub(super) tau: Lanes,
}

/// The largest ratio of modelled to captured albedo that is linearised.
const TRUSTED: f32 = 10.0;

impl Albedo {
    pub(super) fn new(normal: &Normal, profiles: &Field, weight: f32) -> Self {
        let mut roots = Field::new(Geometry { nodes: normal.rings.len(), ..normal.geometry });
        let rows: Vec<Vec<Lanes>> =
            parallel::map(normal.geometry.pixels(), |pixel| square_roots(normal, profiles.at(pixel)));
        for (pixel, row) in rows.iter().enumerate() {
            roots.set(pixel, row);
        }
        roots.fill_border();
        let deltas = normal.deltas(&roots);
        Self { roots, deltas, weight }
    }

    /// Takes over the new profile of a pixel; call [`Albedo::fill_border`] after a batch of these.
    pub(super) fn set(&mut self, normal: &Normal, pixel: usize, profile: &[Lanes]) {
        self.roots.set(pixel, &square_roots(normal, profile));
    }

    pub(super) fn fill_border(&mut self) {
        self.roots.fill_border();
    }

    /// With Rd_j = f_x f_j at ring r and weights a(r): ε = Σ_j Rd_j / ρ − 1 has the derivative Σ_{j≠x} ½ Rd_j a / ρ +
    /// Rd_x a / ρ, since both ends of the pair of x with itself move; ρ is what the capture says. No constraint where
    /// the capture says nothing.
    pub(super) fn constraint(&self, normal: &Normal, profile: &[Lanes], pixel: usize) -> Constraint {
        let mut sums = vec![ZERO; normal.rings.len()];
        normal.ring_sums(&self.roots, &self.deltas, pixel, &mut sums);
        let mut k = vec![ZERO; profile.len()];
        let mut tau = ZERO;
        let rings = normal.rings.iter().zip(self.roots.at(pixel)).zip(&sums);
        for c in 0..3 {
            #[allow(clippy::cast_possible_truncation, reason = "a sum of f32 values")]
            let reference = normal.exchange[pixel][c] as f32;
            if reference <= 0.0 {
                continue;
            }
            let mut exchange = 0.0;
            for ((ring, root), sum) in rings.clone() {
                // A pair counts once for each direction that was measured, and an exchange is the mean of both.
                let rd = 0.5 * root[c] * sum[c] / reference;
                exchange += rd;
                let slope = if ring.is_self() { rd } else { 0.5 * rd };
                k[ring.h][c] += (1.0 - ring.w) * slope;
                k[ring.h + 1][c] += ring.w * slope;
            }
            // Where the model is far off, or the capture all but black, a line says nothing about the albedo.
            if !(0.0..TRUSTED).contains(&exchange) {
                k.iter_mut().for_each(|k| k[c] = 0.0);
                continue;
            }
            let product: f32 = k.iter().zip(profile).map(|(k, p)| k[c] * p[c]).sum();
            tau[c] = product - (exchange - 1.0);
        }
        Constraint { weight: self.weight, k, tau }
    }
}

fn square_roots(normal: &Normal, profile: &[Lanes]) -> Vec<Lanes> {
    let log = |h: usize, c: usize| profile[h][c] + normal.mean[h][c];
    let root = |h: usize, w: f32, c: usize| (0.5 * ((1.0 - w) * log(h, c) + w * log(h + 1, c))).exp();
    let rings = normal.rings.iter();
    rings.map(|ring| [root(ring.h, ring.w, 0), root(ring.h, ring.w, 1), root(ring.h, ring.w, 2), 0.0]).collect()
}
