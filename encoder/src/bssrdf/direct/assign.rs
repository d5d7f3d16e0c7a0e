//! Step B: base materials and ratio of every pixel, profiles fixed.

use std::borrow::Cow;

use rayon::prelude::*;

use super::super::banded::Banded;
use super::super::field::Field;
use super::super::lanes::{Lanes, ZERO};
use super::super::normal::Normal;
use super::albedo::{Albedo, Constraint};
use super::{Mixture, Model};

/// Pixels this far apart in x and in y change together: φ is small between them, and threads have work.
const COLOURS: usize = 4;
/// A matrix that this many pixels share is worth a table of its own.
const SHARED: u32 = 4;

/// Weight of the squared relative albedo error of a pixel against its cost in eq. 5. Large enough that the albedo
/// decides among mixtures of about the same cost; ten times more or less changes little.
const ALBEDO_WEIGHT: f32 = 1e4;

/// Improves every pixel once, Gauss-Seidel fashion: each sees the latest profiles of all but its own colour. With
/// `albedo` the error of the pixel's albedo counts too.
pub(super) fn search(normal: &Normal, model: &mut Model, field: &mut Field, mut albedo: Option<&mut Albedo>) {
    let deltas = normal.deltas(field);
    let tables: Vec<Option<Curvatures>> = normal
        .matrices
        .par_iter()
        .zip(normal.matrix_users())
        .map(|(matrix, users)| (users >= SHARED).then(|| Curvatures::new(&matrix.curvature(), model)))
        .collect();

    let [width, height] = normal.geometry.size;
    for colour in 0..COLOURS * COLOURS {
        let (x0, y0) = (colour % COLOURS, colour / COLOURS);
        let pixels: Vec<usize> = (y0..height)
            .step_by(COLOURS)
            .flat_map(|y| (x0..width).step_by(COLOURS).map(move |x| x + y * width))
            .collect();
        let best = |&pixel: &usize| {
            let matrix = normal.matrix_of[pixel] as usize;
            let curvatures = match &tables[matrix] {
                Some(table) => Cow::Borrowed(table),
                None => Cow::Owned(Curvatures::new(&normal.matrices[matrix].curvature(), model)),
            };
            let u = slopes(normal, model, field, &deltas, pixel);
            let tilt = albedo.as_deref().map(|albedo| {
                let constraint = albedo.constraint(normal, field.at(pixel), pixel);
                Tilt::new(&constraint, model)
            });
            curvatures.best(&u, tilt.as_ref())
        };
        let best: Vec<Mixture> = pixels.par_iter().map(best).collect();
        for (&pixel, &mixture) in pixels.iter().zip(&best) {
            model.mixtures[pixel] = mixture;
            let profile = model.profile(pixel);
            field.set(pixel, &profile);
            if let Some(albedo) = &mut albedo {
                albedo.set(normal, pixel, &profile);
            }
        }
        field.fill_border();
        if let Some(albedo) = &mut albedo {
            albedo.fill_border();
        }
    }
}

/// u_b = Σ_c P̂_bᵀ d of every base, with d = b_i − Σ_{j≠i} φ n a aᵀ p_j: half the slope of the pixel's cost along P̂_b.
fn slopes(normal: &Normal, model: &Model, field: &Field, deltas: &[isize], pixel: usize) -> Vec<f32> {
    let mut d = vec![ZERO; model.nodes];
    normal.cross(field, deltas, pixel, &mut d);
    // The sum has the pixel's own old profile in it; take that out again.
    let mut own = vec![ZERO; model.nodes];
    normal.matrix(pixel).own.multiply_add(field.at(pixel), &mut own);
    for ((d, own), b) in d.iter_mut().zip(&own).zip(normal.b(pixel)) {
        for c in 0..4 {
            d[c] = b[c] - (d[c] - own[c]);
        }
    }
    model.bases.chunks(model.nodes).map(|base| product(base, &d)).collect()
}

/// Σ_h Σ_c p q.
fn product(p: &[Lanes], q: &[Lanes]) -> f32 {
    let mut sum = ZERO;
    for (p, q) in p.iter().zip(q) {
        for c in 0..4 {
            sum[c] += p[c] * q[c];
        }
    }
    sum.iter().sum()
}

/// What the cost of a pixel with a given matrix A looks like along every pair of bases.
///
/// The cost of the profile p is pᵀ A p − 2 pᵀ d. Between P̂_b' (t = 0) and P̂_b (t = 1) it is
/// f(t) = f_b' + t (f_b − f_b') − t (1 − t) e with e = (P̂_b − P̂_b')ᵀ A (P̂_b − P̂_b').
#[derive(Clone)]
struct Curvatures {
    /// P̂_bᵀ A P̂_b.
    pure: Vec<f32>,
    /// e of all pairs b' < b, row by row.
    e: Vec<f32>,
}

impl Curvatures {
    fn new(matrix: &Banded, model: &Model) -> Self {
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
        let mut e = Vec::with_capacity(bases.len() * bases.len() / 2);
        for b in 0..bases.len() {
            for other in 0..b {
                let mixed = product(bases[b], &images[other]);
                e.push((pure[b] + pure[other] - 2.0 * mixed).max(0.0));
            }
        }
        Self { pure, e }
    }

    /// The best pair and ratio for slopes `u`; of equals the first.
    fn best(&self, u: &[f32], tilt: Option<&Tilt>) -> Mixture {
        let mut cost: Vec<f32> = self.pure.iter().zip(u).map(|(pure, u)| pure - 2.0 * u).collect();
        if let Some(tilt) = tilt {
            for (cost, tilt) in cost.iter_mut().zip(&tilt.pure) {
                *cost += tilt;
            }
        }
        let mut best = Mixture { base: [0, 0], t: 1.0 };
        let mut lowest = f32::INFINITY;
        let mut rows = &self.e[..];
        let mut tilted = Vec::with_capacity(cost.len());
        for (b, &at_b) in cost.iter().enumerate() {
            if at_b < lowest {
                lowest = at_b;
                best = Mixture { base: [b, b], t: 1.0 };
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
            let lowest_here = lowest_of_row(&cost[..b], at_b, row);
            if lowest_here < lowest {
                lowest = lowest_here;
                let found = (0..b).map(|other| (other, minimum(cost[other], at_b, row[other])));
                if let Some((other, (_, t))) = found.into_iter().find(|(_, found)| found.0 == lowest) {
                    best = Mixture { base: [b, other], t };
                }
            }
        }
        best
    }
}

/// What a pixel's albedo adds to its costs: w Σ_c (k·p − τ)², with the part that does not depend on p left out.
struct Tilt {
    /// √w k·P̂_b of every base, by channel.
    kappa: [Vec<f32>; 3],
    /// w Σ_c ((k·P̂_b)² − 2 τ k·P̂_b).
    pure: Vec<f32>,
}

impl Tilt {
    fn new(constraint: &Constraint, model: &Model) -> Self {
        let root = ALBEDO_WEIGHT.sqrt();
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
fn lowest_of_row(cost: &[f32], at_b: f32, e: &[f32]) -> f32 {
    const WIDTH: usize = 8;
    let mut lowest = [f32::INFINITY; WIDTH];
    let (costs, cost_rest) = cost.as_chunks::<WIDTH>();
    let (es, e_rest) = e.as_chunks::<WIDTH>();
    for (cost, e) in costs.iter().zip(es) {
        for k in 0..WIDTH {
            lowest[k] = lowest[k].min(minimum(cost[k], at_b, e[k]).0);
        }
    }
    let rest = cost_rest.iter().zip(e_rest).map(|(&cost, &e)| minimum(cost, at_b, e).0);
    lowest.into_iter().chain(rest).fold(f32::INFINITY, f32::min)
}

/// Minimum over t in 0 to 1 of f(t) = f_0 + t (f_1 − f_0) − t (1 − t) e, and the t where it is.
#[inline]
fn minimum(f_0: f32, f_1: f32, e: f32) -> (f32, f32) {
    let slope = f_1 - f_0;
    // The vertex; for equal profiles (e = 0) any t will do.
    let t = (0.5 - 0.5 * slope / (e + f32::MIN_POSITIVE)).clamp(0.0, 1.0);
    (f_0 + t * slope - t * (1.0 - t) * e, t)
}
