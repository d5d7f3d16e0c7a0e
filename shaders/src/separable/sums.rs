//! Weighted sums over the profiles of pixels, which the pass `profile_sums.wgsl` computes when a file is loaded.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{BssrdfHeader, Knot, SeparableBasis};

use crate::rgb::Rgb;

/// Parts of an interval between nodes, each with one value for all offsets in it.
const PARTS: f32 = 4.0;

/// One or two sums over the log-scale profile of a pixel, y_l(x) = Σ_k d_lk exp(s_k P̂_x(r_k)).
#[derive(Clone, Debug)]
pub struct ProfileSums {
    /// Knots of the distances r_k, with the factors s_k.
    pub(crate) knots: Vec<(Knot, f32)>,
    /// Factors d_l, shape `[l][k]`.
    pub(crate) factors: Vec<Vec<Rgb>>,
}

impl ProfileSums {
    /// Coefficients of a separable basis, c_l(x) = Σ_h d_lh exp(½ P̂_x^h), for profiles as the header says; nodes without a
    /// factor are left out.
    #[must_use]
    pub fn coefficients(header: &BssrdfHeader, basis: &SeparableBasis<'_>) -> Self {
        let terms = basis.size().terms;
        let counts = |h: &usize| (0..terms).any(|l| basis.projection(l, *h) != [0.0; 3]);
        let nodes: Vec<usize> = (0..usize::from(header.samples)).filter(counts).collect();
        // The last node is the end of the last interval.
        let last = usize::from(header.samples).saturating_sub(2);
        let knot = |h: usize| if h > last { Knot { h: last, w: 1.0 } } else { Knot { h, w: 0.0 } };
        Self {
            knots: nodes.iter().map(|h| (knot(*h), 0.5)).collect(),
            factors: (0..terms).map(|l| nodes.iter().map(|h| basis.projection(l, *h)).collect()).collect(),
        }
    }

    /// Albedo Σ exp(P̂_x(r)) pitch² over the window: approximate, as if all around a pixel were like it.
    #[must_use]
    pub fn albedo(material: &Bssrdf<'_>) -> Self {
        let header = material.header();
        let area = header.pitch_mm * header.pitch_mm;
        // Number of offsets in every part of every interval, and their mean place.
        let intervals = usize::from(header.samples) - 1;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
        let mut parts = vec![(0.0_f32, 0.0_f32); intervals * PARTS as usize];
        let radius = i32::from(header.window_radius);
        for [dx, dy] in (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy])) {
            if let Some(knot) = material.distance_mm(dx, dy).and_then(|r_mm| material.knot(r_mm)) {
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "w is 0 to 1")]
                let part = ((PARTS * knot.w) as usize).min(PARTS as usize - 1);
                #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
                let (count, sum) = &mut parts[knot.h * PARTS as usize + part];
                *count += 1.0;
                *sum += knot.w;
            }
        }
        let taken = parts.iter().enumerate().filter(|(_, (count, _))| *count > 0.0);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
        let knot = |(part, (count, places)): (usize, &(f32, f32))| {
            ((Knot { h: part / PARTS as usize, w: places / count }, 1.0), [count * area; 3])
        };
        let (knots, factors) = taken.map(knot).unzip();
        Self { knots, factors: vec![factors] }
    }

    /// 1 for all pixels.
    #[must_use]
    pub fn one() -> Self {
        Self { knots: vec![(Knot { h: 0, w: 0.0 }, 0.0)], factors: vec![vec![[1.0; 3]]] }
    }

    /// Number of sums, 1 or 2.
    #[must_use]
    pub fn count(&self) -> usize {
        self.factors.len()
    }

    /// Table of `profile_sums.wgsl`: the number of knots; knots, as node, weight of the next and s; factors of two sums.
    #[must_use]
    pub fn texels(&self) -> Vec<[f32; 4]> {
        #[allow(clippy::cast_precision_loss, reason = "at most 16,384 of them")]
        let count = self.knots.len() as f32;
        #[allow(clippy::cast_precision_loss, reason = "at most 4,096 nodes")]
        let knots = self.knots.iter().map(|(knot, s)| [knot.h as f32, knot.w, *s, 0.0]);
        let none = vec![[0.0; 3]; self.knots.len()];
        let second = self.factors.get(1).unwrap_or(&none);
        let factors = self.factors[0].iter().chain(second).map(|[r, g, b]| [*r, *g, *b, 0.0]);
        std::iter::once([count, 0.0, 0.0, 0.0]).chain(knots).chain(factors).collect()
    }
}
