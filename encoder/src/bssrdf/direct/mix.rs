//! The cheapest mixture of one pixel.

use subsurf_decoder::bssrdf::Mixture;
use subsurf_decoder::bssrdf::layout::MAX_PER_PIXEL;

use super::albedo::Constraint;
use crate::bssrdf::model::Model;
use crate::math::banded::Banded;
use crate::math::lanes::{Lanes, ZERO};

/// Scalar product Σ_h Σ_c p q of two profiles.
pub(super) fn product(p: &[Lanes], q: &[Lanes]) -> f32 {
    let mut sum = ZERO;
    for (p, q) in p.iter().zip(q) {
        for c in 0..4 {
            sum[c] += p[c] * q[c];
        }
    }
    sum.iter().sum()
}

/// Curvatures of the cost of a pixel with a given matrix A, along every pair of bases.
///
/// The cost of the profile p is pᵀ A p − 2 pᵀ d. Between P̂_b' (t = 0) and P̂_b (t = 1) it is
/// f(t) = f_b' + t (f_b − f_b') − t (1 − t) e with e = (P̂_b − P̂_b')ᵀ A (P̂_b − P̂_b').
#[derive(Clone)]
pub(super) struct Curvatures {
    /// Quadratic term P̂_bᵀ A P̂_b of every base.
    pure: Vec<f32>,
    /// Spread e of all pairs b' < b, row by row.
    e: Vec<f32>,
}

impl Curvatures {
    pub(super) fn new(matrix: &Banded, model: &Model) -> Self {
        let bases: Vec<&[Lanes]> = model.bases.chunks(model.nodes).collect();
        let images: Vec<Vec<Lanes>> = bases
            .iter()
            .map(|base| {
                let mut image = vec![ZERO; model.nodes];
                matrix.multiply_add(base, &mut image);
                image
            })
            .collect();
        let pure: Vec<f32> = bases.iter().zip(&images).map(|(base, image)| product(base, image)).collect();
        // One base material per pixel needs no pairs, and has too many of them.
        let paired = if model.per_pixel > 1 { bases.len() } else { 0 };
        let mut e = Vec::with_capacity(paired * paired / 2);
        for b in 0..paired {
            for other in 0..b {
                let mixed = product(bases[b], &images[other]);
                e.push((pure[b] + pure[other] - 2.0 * mixed).max(0.0));
            }
        }
        Self { pure, e }
    }

    /// The best mixture that `model` allows for slopes `u`; of equals the first.
    ///
    /// Exact for one and two. More start from the best pair and from the `current` mixture, whichever leads lower.
    pub(super) fn best(&self, u: &[f32], tilt: Option<&Tilt>, model: &Model, current: &Mixture) -> Mixture {
        let mut cost: Vec<f32> = self.pure.iter().zip(u).map(|(pure, u)| pure - 2.0 * u).collect();
        if let Some(tilt) = tilt {
            for (cost, tilt) in cost.iter_mut().zip(&tilt.pure) {
                *cost += tilt;
            }
        }
        let costs = Costs { curvatures: self, tilt, cost: &cost };
        let per_pixel = model.per_pixel;
        if per_pixel == 1 {
            return Blend::of_one(lowest_of(&cost)).mixture();
        }
        let pair = match (&model.palette, model.levels) {
            (_, None) => self.best_pair(&cost, tilt, |t| t),
            (None, Some(levels)) => self.best_pair(&cost, tilt, |t| snapped(t, levels)),
            (Some(pairs), Some(levels)) => costs.best_of(pairs, levels),
        };
        if per_pixel == 2 {
            return pair.mixture();
        }
        let from_pair = costs.grown(pair, per_pixel);
        let from_current = costs.grown(Blend::of(current, per_pixel), per_pixel);
        let best = if costs.of(&from_current) <= costs.of(&from_pair) { from_current } else { from_pair };
        best.mixture()
    }

    /// The best pair and ratio for the costs of single base materials; `snap` gives the ratio that can be stored.
    fn best_pair(&self, cost: &[f32], tilt: Option<&Tilt>, snap: impl Fn(f32) -> f32) -> Blend {
        let mut best = Blend::of_one(0);
        let mut lowest = f32::INFINITY;
        let mut rows = &self.e[..];
        let mut tilted = Vec::with_capacity(cost.len());
        for (b, &at_b) in cost.iter().enumerate() {
            if at_b < lowest {
                lowest = at_b;
                best = Blend::of_one(b);
            }
            let (row, rest) = rows.split_at(b);
            rows = rest;
            let row = match tilt {
                Some(tilt) => {
                    tilt.add_to(b, row, &mut tilted);
                    &tilted
                }
                None => row,
            };
            let lowest_here = lowest_of_row(&cost[..b], at_b, row, &snap);
            if lowest_here < lowest {
                lowest = lowest_here;
                let found = (0..b).map(|other| (other, minimum(cost[other], at_b, row[other], &snap)));
                if let Some((other, (_, t))) = found.into_iter().find(|(_, found)| found.0 == lowest) {
                    best = Blend { count: 2, bases: [b, other, 0, 0, 0], ratios: [t, 1.0 - t, 0.0, 0.0, 0.0] };
                }
            }
        }
        best
    }

    /// Spread e of two base materials.
    fn pair(&self, a: usize, b: usize) -> f32 {
        let (low, high) = (a.min(b), a.max(b));
        if low == high { 0.0 } else { self.e[high * (high - 1) / 2 + low] }
    }
}

/// Base materials and ratios of one pixel while it is searched; those beyond `count` mean nothing.
#[derive(Clone, Copy)]
struct Blend {
    count: usize,
    bases: [usize; MAX_PER_PIXEL],
    ratios: [f32; MAX_PER_PIXEL],
}

impl Blend {
    fn of_one(base: usize) -> Self {
        Self { count: 1, bases: [base; MAX_PER_PIXEL], ratios: [1.0, 0.0, 0.0, 0.0, 0.0] }
    }

    /// The parts of a mixture that are there.
    fn of(mixture: &Mixture, per_pixel: usize) -> Self {
        let mut blend = Self { count: 0, bases: [0; MAX_PER_PIXEL], ratios: [0.0; MAX_PER_PIXEL] };
        for (&base, &t) in mixture.bases.iter().zip(&mixture.ratios).take(per_pixel) {
            if t > 0.0 {
                blend.bases[blend.count] = base.into();
                blend.ratios[blend.count] = t;
                blend.count += 1;
            }
        }
        blend
    }

    fn mixture(&self) -> Mixture {
        let mut mixture = Mixture::default();
        // Shares are moved about many times; what rounding did to their sum ends here.
        let sum: f32 = self.parts().map(|(_, t)| t).sum();
        for k in 0..self.count {
            mixture.bases[k] = u16::try_from(self.bases[k]).expect("at most 65,536 base materials");
            mixture.ratios[k] = if self.count > 2 { self.ratios[k] / sum } else { self.ratios[k] }.min(1.0);
        }
        // Parts that are not there name the first base material, whose profile is at hand anyway.
        for base in &mut mixture.bases[self.count..] {
            *base = u16::try_from(self.bases[0]).expect("at most 65,536 base materials");
        }
        mixture
    }

    fn parts(&self) -> impl Iterator<Item = (usize, f32)> {
        self.bases.into_iter().zip(self.ratios).take(self.count)
    }

    /// Leaves out what has no share.
    fn drop_empty(&mut self) {
        let kept: Vec<(usize, f32)> = self.parts().filter(|(_, t)| *t > 0.0).collect();
        self.count = kept.len();
        for (k, (base, t)) in kept.into_iter().enumerate() {
            self.bases[k] = base;
            self.ratios[k] = t;
        }
    }
}

/// Costs of all mixtures of one pixel: f(t) = Σ_k t_k f_k − Σ_{k<l} t_k t_l e_kl, with Σ t_k = 1.
struct Costs<'a> {
    curvatures: &'a Curvatures,
    tilt: Option<&'a Tilt>,
    /// f of every base material alone.
    cost: &'a [f32],
}

/// Sweeps over all pairs of a mixture's parts; five parts seldom need more than a few.
const SWEEPS: usize = 24;
/// A base material joins a mixture if that lowers the cost by more than this share of the magnitude of the costs.
const WORTHWHILE: f32 = 1e-6;

impl Costs<'_> {
    fn e(&self, a: usize, b: usize) -> f32 {
        self.curvatures.pair(a, b) + self.tilt.map_or(0.0, |tilt| tilt.pair(a, b))
    }

    /// The best of some pairs, with ratios that are whole multiples of 1/levels.
    fn best_of(&self, pairs: &[[usize; 2]], levels: f32) -> Blend {
        let mut best = (f32::INFINITY, Blend::of_one(0));
        for &[b, other] in pairs {
            let (cost, t) = minimum(self.cost[other], self.cost[b], self.e(b, other), |t| snapped(t, levels));
            if cost < best.0 {
                best = (cost, Blend { count: 2, bases: [b, other, 0, 0, 0], ratios: [t, 1.0 - t, 0.0, 0.0, 0.0] });
            }
        }
        best.1
    }

    fn of(&self, blend: &Blend) -> f32 {
        let alone: f32 = blend.parts().map(|(b, t)| t * self.cost[b]).sum();
        alone - self.spread(blend)
    }

    /// Sum Σ_{k<l} t_k t_l e_kl over the parts of a mixture.
    fn spread(&self, blend: &Blend) -> f32 {
        let parts = || blend.parts().enumerate();
        let pairs = parts().flat_map(|(k, a)| parts().take(k).map(move |(_, b)| (a, b)));
        pairs.map(|((a, t), (b, s))| t * s * self.e(a, b)).sum()
    }

    /// Adds base materials to a mixture until it has `per_pixel`: each time the one towards which the cost falls lowest
    /// along a straight line; then the ratios of all are made the best again.
    fn grown(&self, mut blend: Blend, per_pixel: usize) -> Blend {
        self.balance(&mut blend);
        while blend.count < per_pixel {
            let (here, spread) = (self.of(&blend), self.spread(&blend));
            let mut best = (here - WORTHWHILE * here.abs(), None);
            for b in 0..self.cost.len() {
                // ‖p − P̂_b‖² in the metric of A.
                let distance = blend.parts().map(|(a, t)| t * self.e(a, b)).sum::<f32>() - spread;
                let (cost, s) = minimum(here, self.cost[b], distance.max(0.0), |t| t);
                if cost < best.0 && blend.parts().all(|(a, _)| a != b) {
                    best = (cost, Some((b, s)));
                }
            }
            let (_, Some((b, s))) = best else {
                break;
            };
            for t in &mut blend.ratios[..blend.count] {
                *t *= 1.0 - s;
            }
            blend.bases[blend.count] = b;
            blend.ratios[blend.count] = s;
            blend.count += 1;
            self.balance(&mut blend);
        }
        blend
    }

    /// The best ratios of a mixture's base materials: pair by pair, what one has more the other has less.
    fn balance(&self, blend: &mut Blend) {
        for _ in 0..SWEEPS {
            let mut moved = 0.0_f32;
            for k in 0..blend.count {
                for l in 0..k {
                    let e = self.e(blend.bases[k], blend.bases[l]);
                    let slope = self.slope(blend, k) - self.slope(blend, l);
                    let step = (-0.5 * slope / (e + f32::MIN_POSITIVE)).clamp(-blend.ratios[k], blend.ratios[l]);
                    blend.ratios[k] += step;
                    blend.ratios[l] -= step;
                    moved = moved.max(step.abs());
                }
            }
            if moved < 1e-5 {
                break;
            }
        }
        blend.drop_empty();
    }

    /// ∂f/∂t_k = f_k − Σ_l t_l e_kl.
    fn slope(&self, blend: &Blend, k: usize) -> f32 {
        let b = blend.bases[k];
        self.cost[b] - blend.parts().map(|(a, t)| t * self.e(a, b)).sum::<f32>()
    }
}

/// Number of the lowest cost; of equals the first.
fn lowest_of(cost: &[f32]) -> usize {
    let lowest = cost.iter().enumerate().min_by(|a, b| a.1.total_cmp(b.1));
    lowest.map_or(0, |(b, _)| b)
}

/// What a pixel's albedo adds to its costs: w Σ_c (k·p − τ)², with the part that does not depend on p left out.
pub(super) struct Tilt {
    /// √w k·P̂_b of every base, by channel.
    kappa: [Vec<f32>; 3],
    /// w Σ_c ((k·P̂_b)² − 2 τ k·P̂_b).
    pure: Vec<f32>,
}

impl Tilt {
    pub(super) fn new(constraint: &Constraint, model: &Model) -> Self {
        let root = constraint.weight.sqrt();
        let kappa = [0, 1, 2].map(|c| {
            let along = |base: &[Lanes]| base.iter().zip(&constraint.k).map(|(p, k)| p[c] * k[c]).sum::<f32>();
            model.bases.chunks(model.nodes).map(|base| root * along(base)).collect::<Vec<f32>>()
        });
        let pure = (0..kappa[0].len()).map(|b| {
            let term = |c: usize| kappa[c][b] * (kappa[c][b] - 2.0 * root * constraint.tau[c]);
            term(0) + term(1) + term(2)
        });
        Self { pure: pure.collect(), kappa }
    }

    /// What the tilt adds to e of two base materials.
    fn pair(&self, a: usize, b: usize) -> f32 {
        self.kappa.iter().map(|kappa| (kappa[a] - kappa[b]) * (kappa[a] - kappa[b])).sum()
    }

    /// e of base `b` with all before it, tilt included: w Σ_c (k·(P̂_b − P̂_b'))² more.
    fn add_to(&self, b: usize, row: &[f32], out: &mut Vec<f32>) {
        out.clear();
        out.extend_from_slice(row);
        for kappa in &self.kappa {
            let (before, at_b) = (&kappa[..b], kappa[b]);
            for (e, kappa) in out.iter_mut().zip(before) {
                *e += (at_b - kappa) * (at_b - kappa);
            }
        }
    }
}

/// Lowest cost of one base with any of those before it. No branches: this is the innermost loop of the search.
fn lowest_of_row(cost: &[f32], at_b: f32, e: &[f32], snap: &impl Fn(f32) -> f32) -> f32 {
    const WIDTH: usize = 8;
    let mut lowest = [f32::INFINITY; WIDTH];
    let (costs, cost_rest) = cost.as_chunks::<WIDTH>();
    let (es, e_rest) = e.as_chunks::<WIDTH>();
    for (cost, e) in costs.iter().zip(es) {
        for k in 0..WIDTH {
            lowest[k] = lowest[k].min(minimum(cost[k], at_b, e[k], snap).0);
        }
    }
    let rest = cost_rest.iter().zip(e_rest).map(|(&cost, &e)| minimum(cost, at_b, e, snap).0);
    lowest.into_iter().chain(rest).fold(f32::INFINITY, f32::min)
}

/// Minimum over t in 0 to 1 of f(t) = f_0 + t (f_1 − f_0) − t (1 − t) e, and the t where it is.
///
/// `snap` moves t to the nearest one allowed: a parabola rises alike on both sides of its vertex.
#[inline]
fn minimum(f_0: f32, f_1: f32, e: f32, snap: impl Fn(f32) -> f32) -> (f32, f32) {
    let slope = f_1 - f_0;
    // The vertex; for equal profiles (e = 0) any t will do.
    let t = snap((0.5 - 0.5 * slope / (e + f32::MIN_POSITIVE)).clamp(0.0, 1.0));
    (f_0 + t * slope - t * (1.0 - t) * e, t)
}

/// The whole multiple of 1/levels next to t, which is in 0 to 1.
#[inline]
fn snapped(t: f32, levels: f32) -> f32 {
    // A number so large that floats beside it are whole: adding it rounds, without a call.
    const WHOLE: f32 = 12_582_912.0;
    ((t * levels + WHOLE) - WHOLE) / levels
}
