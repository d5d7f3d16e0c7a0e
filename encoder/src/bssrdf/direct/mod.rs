//! K-BMPP by alternation: base materials searched for every pixel, base profiles solved for.
//!
//! Yatagawa et al. 2020 alternate L-BFGS-B with a randomised search; both halves have better answers. With the base
//! profiles fixed, a pixel's cost is a quadratic in its own profile, and the best ratio of each of the M (M − 1)/2 base
//! pairs is the vertex of a parabola; further base materials join the best pair one by one ([`assign`]). With indices
//! and ratios fixed, the cost is a quadratic in all base profiles together ([`solve`]).

mod albedo;
mod assign;
mod mix;
mod solve;

use std::collections::BTreeMap;

use rayon::prelude::*;
use subsurf_decoder::bssrdf::layout::{MAX_CODED_RATIO, MAX_PAIRS, MODELS_BMPP};
use subsurf_decoder::bssrdf::{Coding, Mixture};

pub(crate) use solve::{gather, image_of};

use crate::bssrdf::clusters::Clusters;
use crate::bssrdf::field::Field;
use crate::math::lanes::{self, Lanes, ZERO};
use crate::bssrdf::normal::Normal;
use crate::progress::Progress;
use albedo::Albedo;

/// Rounds of both steps, at most.
const ROUNDS: u64 = 6;
/// The cost has settled when a round lowers it by less than this share.
const SETTLED: f64 = 2e-3;

/// Rounds of both steps after that, in which the search weighs albedos.
const WEIGHED_ROUNDS: u64 = 4;
/// Rounds of both steps in which the pairs that pixels may have become fewer, down to a palette.
const PRUNING_ROUNDS: u8 = 6;
/// Sweeps of the search that end it all, albedos weighed.
const POLISH: u64 = 4;

/// Weight of the squared relative albedo error of a pixel against its cost in eq. 5. Large enough that the albedo decides
/// among mixtures of about the same cost. Ratios in steps leave larger errors to decide about.
fn albedo_weight(coding: Coding) -> f32 {
    match coding {
        Coding::Exact => 1e4,
        Coding::SmallRatios => 1.2e4,
        Coding::Palette => 4e4,
    }
}

/// A K-BMPP model relative to the mean profile.
pub(crate) struct Model {
    pub(crate) nodes: usize,
    /// K.
    pub(crate) per_pixel: usize,
    /// Ratios are whole multiples of 1/levels, if they are to be stored so.
    pub(crate) levels: Option<f32>,
    /// The only pairs there may be, sorted.
    pub(crate) palette: Option<Vec<[usize; 2]>>,
    /// `[base][node]`.
    pub(crate) bases: Vec<Lanes>,
    pub(crate) mixtures: Vec<Mixture>,
}

impl Model {
    /// Every pixel is its cluster.
    pub(crate) fn of_clusters(clusters: Clusters, nodes: usize) -> Self {
        let mixture = |&cluster: &usize| {
            let cluster = u16::try_from(cluster).expect("at most 65,536 clusters");
            Mixture { bases: [cluster; 5], ratios: [1.0, 0.0, 0.0, 0.0, 0.0] }
        };
        let mixtures = clusters.cluster_of.iter().map(mixture).collect();
        Self { nodes, per_pixel: 1, levels: None, palette: None, bases: clusters.centres, mixtures }
    }

    /// Leaves out base materials that no pixel has: a capture may have fewer distinct profiles than were asked for.
    pub(crate) fn drop_unused(&mut self) {
        let mut used = vec![false; self.count()];
        for (base, _) in (0..self.mixtures.len()).flat_map(|pixel| self.parts(pixel)) {
            used[base] = true;
        }
        let mut kept = 0;
        let number = |&used: &bool| {
            let number = u16::try_from(kept).expect("at most 65,536 base materials");
            kept += usize::from(used);
            number
        };
        let numbers: Vec<u16> = used.iter().map(number).collect();
        for base in self.mixtures.iter_mut().flat_map(|mixture| &mut mixture.bases[..self.per_pixel]) {
            *base = numbers[usize::from(*base)];
        }
        let bases = self.bases.chunks(self.nodes).zip(&used).filter(|(_, used)| **used);
        self.bases = bases.flat_map(|(base, _)| base).copied().collect();
    }

    /// M.
    pub(crate) fn count(&self) -> usize {
        self.bases.len() / self.nodes
    }

    /// Restricts what the search may find to what a coding can store; a palette to the `most` used pairs.
    fn restrict(&mut self, coding: Coding, most: usize) {
        self.levels = match coding {
            Coding::Exact => None,
            Coding::SmallRatios => Some(f32::from(u8::MAX)),
            Coding::Palette => Some(f32::from(MAX_CODED_RATIO)),
        };
        if coding == Coding::Palette {
            // The pairs that most pixels have; of equals the first.
            let mut uses: BTreeMap<[usize; 2], usize> = BTreeMap::new();
            for mixture in &self.mixtures {
                let [a, b] = [mixture.bases[0], mixture.bases[1]].map(usize::from);
                *uses.entry([a.min(b), a.max(b)]).or_default() += 1;
            }
            let mut pairs: Vec<([usize; 2], usize)> = uses.into_iter().collect();
            pairs.sort_by_key(|(_, uses)| std::cmp::Reverse(*uses));
            let mut pairs: Vec<[usize; 2]> = pairs.into_iter().map(|(pair, _)| pair).collect();
            pairs.truncate(most);
            pairs.sort_unstable();
            self.palette = Some(pairs);
        }
    }

    fn base(&self, base: usize) -> &[Lanes] {
        &self.bases[base * self.nodes..][..self.nodes]
    }

    /// b_k and t_k of one pixel.
    fn parts(&self, pixel: usize) -> impl Iterator<Item = (usize, f32)> {
        let Mixture { bases, ratios } = self.mixtures[pixel];
        bases.into_iter().zip(ratios).take(self.per_pixel).map(|(base, t)| (base.into(), t))
    }

    /// P̂_x = Σ t_k P̂_{b_k} of one pixel (eq. 4).
    fn profile(&self, pixel: usize) -> Vec<Lanes> {
        let mut profile = vec![ZERO; self.nodes];
        for (base, t) in self.parts(pixel) {
            for (sum, p) in profile.iter_mut().zip(self.base(base)) {
                lanes::add_scaled(sum, t, p);
            }
        }
        profile
    }

    /// All pixels' profiles.
    pub(crate) fn field(&self, normal: &Normal) -> Field {
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

/// Alternates both steps from a model of one base material per pixel until the cost settles, then lets the search weigh
/// albedos. Three and five base materials per pixel start from the model of fewer, so that they begin no worse.
pub(crate) fn refine(normal: &Normal, model: &mut Model, per_pixel: usize, coding: Coding, progress: &dyn Progress) {
    let mut field = model.field(normal);
    // One base material per pixel is where clusters start, and pairs are searched exhaustively from there.
    let stages = MODELS_BMPP.into_iter().map(usize::from).filter(|&k| k == per_pixel || (1 < k && k < per_pixel));
    let stages: Vec<usize> = stages.collect();
    let pruning = if coding == Coding::Palette { PRUNING_ROUNDS } else { 0 };
    progress
        .begin("fitting base materials", ROUNDS * stages.len() as u64 + WEIGHED_ROUNDS + u64::from(pruning) + POLISH);
    for k in stages {
        model.per_pixel = k;
        if !progress.stopped() {
            alternate(normal, model, &mut field, progress);
        }
    }
    let mut weighed_round = |model: &mut Model, coding| {
        if progress.stopped() {
            return;
        }
        let mut albedo = Albedo::new(normal, &field, albedo_weight(coding));
        assign::search(normal, model, &mut field, Some(&mut albedo));
        solve::solve(normal, model, &mut field);
        progress.advance(1);
    };
    for _ in 0..WEIGHED_ROUNDS {
        weighed_round(model, Coding::Exact);
    }
    for round in 0..pruning {
        // From twice as many pairs down to what a palette holds, by equal factors.
        let left = f64::from(pruning - round) / f64::from(pruning);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 4,096")]
        let most = (f64::from(MAX_PAIRS) * left.exp2()) as usize;
        model.restrict(coding, most);
        weighed_round(model, coding);
    }
    model.restrict(coding, MAX_PAIRS.into());
    let mut albedo = Albedo::new(normal, &field, albedo_weight(coding));
    for _ in 0..POLISH {
        // The first of these sweeps makes ratios and pairs what the coding can store.
        assign::search(normal, model, &mut field, Some(&mut albedo));
        progress.advance(1);
        if progress.stopped() {
            break;
        }
    }
}

/// Rounds of both steps until the cost settles.
fn alternate(normal: &Normal, model: &mut Model, field: &mut Field, progress: &dyn Progress) {
    let mut cost = normal.cost(field);
    for round in 0..ROUNDS {
        assign::search(normal, model, field, None);
        solve::solve(normal, model, field);
        let next = normal.cost(field);
        let settled = next > cost * (1.0 - SETTLED);
        cost = next;
        if settled || progress.stopped() {
            progress.advance(ROUNDS - round);
            break;
        }
        progress.advance(1);
    }
}
