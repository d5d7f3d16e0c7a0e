//! K-BMPP as Yatagawa et al. 2020 fit it, section 3.3: the baseline of comparisons.
//!
//! Algorithm 1 alternates a nonlinear minimisation of eq. 6, indices fixed ([`objective`]), with a randomised search
//! for indices ([`patch_match`]). Where their text leaves a choice open:
//!
//! - Step 1 of every round runs L-BFGS-B until an iteration lowers the cost by less than [`TOLERANCE`] of it, or for
//!   [`STEPS`] iterations. It starts without history: the indices have changed since.
//! - For K ≥ 3 the constraint Σ t_k = 1 of every pixel has a multiplier and a penalty, updated after each round; inside,
//!   L-BFGS-B keeps 0 ≤ t ≤ 1.
//! - Ratios stay [`EDGE`] away from 0 and 1, where the barrier is infinite.

mod objective;
mod patch_match;

use rand::seq::index::sample;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use subsurf_decoder::bssrdf::Mixture;

use crate::bssrdf::model::Model;
use crate::bssrdf::normal::Normal;
use crate::math::lanes::Lanes;
use crate::math::lbfgs::{self, Limits};
use crate::progress::Progress;
use objective::{Energy, Multipliers, parameters_of, with_parameters};

/// Rounds of both steps, N_iter.
const ROUNDS: u32 = 20;
/// Acceptance of the first round, a₀.
const FIRST_ACCEPTANCE: f64 = 0.1;
/// Iterations of L-BFGS-B in one round, at most.
const STEPS: u64 = 500;
/// Costs are sums of single-precision terms; smaller differences than this are not seen.
const TOLERANCE: f64 = 1e-7;
/// Smallest ratio of a base material.
const EDGE: f64 = 1e-6;

/// Fits `count` base materials, `per_pixel` for every pixel (Algorithm 1).
pub(crate) fn fit(normal: &Normal, per_pixel: usize, count: usize, seed: u64, progress: &dyn Progress) -> Model {
    let mut rng = Pcg64::seed_from_u64(seed);
    let mut model = random(normal, per_pixel, count, &mut rng);
    let mut multipliers = Multipliers::new(normal.geometry.pixels());
    // p = (1/a₀)^(2/N_iter): a reaches 1 half way.
    let growth = (1.0 / FIRST_ACCEPTANCE).powf(2.0 / f64::from(ROUNDS));
    let mut acceptance = FIRST_ACCEPTANCE;
    progress.begin("fitting as Yatagawa et al. do", ROUNDS.into());
    for round in 0..ROUNDS {
        minimise(normal, &mut model, &mut multipliers, progress);
        if progress.stopped() {
            normalise(&mut model);
            return model;
        }
        patch_match::search(normal, &mut model, round % 2 == 1, acceptance, &mut rng);
        acceptance = (acceptance * growth).min(1.0);
        progress.advance(1);
    }
    minimise(normal, &mut model, &mut multipliers, progress);
    normalise(&mut model);
    model
}

/// Indices at random, no two of a pixel alike; ratios 1/K; coefficients in −1 to 1.
fn random(normal: &Normal, per_pixel: usize, count: usize, rng: &mut Pcg64) -> Model {
    let profile = |rng: &mut Pcg64| {
        let node =
            |mean: &Lanes| [0, 1, 2, 3].map(|c| if c < 3 { rng.random_range(-1.0..=1.0) - mean[c] } else { 0.0 });
        normal.mean.iter().map(node).collect::<Vec<Lanes>>()
    };
    let bases: Vec<Lanes> = (0..count).flat_map(|_| profile(rng)).collect();
    let mixtures = (0..normal.geometry.pixels()).map(|_| {
        let mut mixture = Mixture::default();
        // With fewer base materials than K, some have to be alike.
        let chosen = sample(rng, count, per_pixel.min(count));
        for k in 0..per_pixel {
            mixture.bases[k] = u16::try_from(chosen.index(k % chosen.len())).expect("at most 65,536 base materials");
            #[allow(clippy::cast_precision_loss, reason = "at most 5")]
            let even = 1.0 / per_pixel as f32;
            mixture.ratios[k] = even;
        }
        mixture
    });
    let mixtures = mixtures.collect();
    Model { nodes: normal.geometry.nodes, per_pixel, levels: None, palette: None, bases, mixtures }
}

/// Step 1: profiles and ratios, indices fixed.
fn minimise(normal: &Normal, model: &mut Model, multipliers: &mut Multipliers, progress: &dyn Progress) {
    let energy = Energy::new(normal, model, multipliers);
    let is_stopped = || progress.stopped();
    let limits = Limits { relative_reduction: TOLERANCE, iterations: STEPS, is_stopped: &is_stopped };
    let found = lbfgs::minimise(&energy, &energy.bounds(), parameters_of(model), &limits);
    *model = with_parameters(model, &found);
    multipliers.update(model);
}

/// Ratios that add up to 1 exactly, as far as f32 can.
fn normalise(model: &mut Model) {
    for mixture in &mut model.mixtures {
        let sum: f32 = mixture.ratios.iter().sum();
        mixture.ratios = mixture.ratios.map(|t| (t / sum).min(1.0));
    }
}
