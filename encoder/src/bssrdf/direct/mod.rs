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

use subsurf_decoder::bssrdf::Coding;
use subsurf_decoder::bssrdf::layout::{MAX_PAIRS, MODELS_BMPP};

use crate::bssrdf::field::Field;
use crate::bssrdf::model::Model;
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
