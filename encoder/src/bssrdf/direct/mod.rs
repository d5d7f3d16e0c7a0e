//! 2-BMPP by exact alternation: all base pairs searched for every pixel, base profiles solved for.
//!
//! Yatagawa et al. 2020 alternate L-BFGS-B with a randomised search; both halves have exact answers. With the base
//! profiles fixed, a pixel's cost is a quadratic in its own profile, and the best ratio of each of the M (M − 1)/2 base
//! pairs is the vertex of a parabola ([`assign`]). With indices and ratios fixed, the cost is a quadratic in all base
//! profiles together ([`profiles`]).

mod albedo;
mod assign;
mod profiles;

use rayon::prelude::*;

use super::cluster::Clusters;
use super::field::Field;
use super::lanes::{Lanes, ZERO};
use super::normal::Normal;
use crate::progress::Progress;
use albedo::Albedo;

/// Rounds of both steps, at most.
const ROUNDS: u64 = 12;
/// The cost has settled when a round lowers it by less than this share.
const SETTLED: f64 = 2e-3;

/// Sweeps of the search that weigh albedos.
const POLISH: u64 = 2;

/// One pixel: t of the first base material, 1 − t of the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Mixture {
    pub(super) base: [usize; 2],
    pub(super) t: f32,
}

/// A 2-BMPP model relative to the mean profile.
pub(super) struct Model {
    nodes: usize,
    /// `[base][node]`.
    pub(super) bases: Vec<Lanes>,
    pub(super) mixtures: Vec<Mixture>,
}

impl Model {
    /// Every pixel is its cluster.
    pub(super) fn of_clusters(clusters: Clusters, nodes: usize) -> Self {
        let mixtures = clusters.cluster_of.iter().map(|&cluster| Mixture { base: [cluster; 2], t: 1.0 }).collect();
        Self { nodes, bases: clusters.centres, mixtures }
    }

    /// Fills up to `count` bases with the mean profile: a capture may have fewer distinct profiles than were asked for.
    pub(super) fn pad(&mut self, count: usize) {
        self.bases.resize(count * self.nodes, ZERO);
    }

    fn base(&self, base: usize) -> &[Lanes] {
        &self.bases[base * self.nodes..][..self.nodes]
    }

    /// P̂_x = t P̂_{b₁} + (1 − t) P̂_{b₂} of one pixel (eq. 4).
    fn profile(&self, pixel: usize) -> Vec<Lanes> {
        let Mixture { base: [first, second], t } = self.mixtures[pixel];
        let pairs = self.base(first).iter().zip(self.base(second));
        pairs.map(|(p, q)| [0, 1, 2, 3].map(|c| q[c] + t * (p[c] - q[c]))).collect()
    }

    /// All pixels' profiles.
    pub(super) fn field(&self, normal: &Normal) -> Field {
        let mut field = Field::new(normal.geometry);
        self.write_to(&mut field);
        field
    }

    fn write_to(&self, field: &mut Field) {
        let profiles: Vec<Vec<Lanes>> =
            (0..self.mixtures.len()).into_par_iter().map(|pixel| self.profile(pixel)).collect();
        for (pixel, profile) in profiles.iter().enumerate() {
            field.set(pixel, profile);
        }
        field.fill_border();
    }
}

/// Alternates both steps from `model` until the cost settles, then lets the search weigh albedos.
pub(super) fn refine(normal: &Normal, model: &mut Model, progress: &dyn Progress) {
    let mut field = model.field(normal);
    let mut cost = normal.cost(&field);
    progress.begin("fitting base materials", ROUNDS + POLISH);
    for round in 0..ROUNDS {
        assign::search(normal, model, &mut field, None);
        profiles::solve(normal, model, &mut field);
        let next = normal.cost(&field);
        let settled = next > cost * (1.0 - SETTLED);
        cost = next;
        if settled {
            progress.advance(ROUNDS - round);
            break;
        }
        progress.advance(1);
    }
    let mut albedo = Albedo::new(normal, &field);
    for _ in 0..POLISH {
        assign::search(normal, model, &mut field, Some(&mut albedo));
        progress.advance(1);
    }
}
