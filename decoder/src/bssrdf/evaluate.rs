//! Rd, profiles and albedo of a checked file (Yatagawa et al. 2020, eq. 1-4).

use super::layout::{BssrdfHeader, MAX_PER_PIXEL};
use super::planes::{BssrdfModel, Profiles};
use super::reader::Bssrdf;
use crate::container::bytes::F32Le;
use crate::container::index::row_major;

/// Colour channels.
const RGB: usize = 3;

/// Place of a distance between two nodes of a profile (eq. 3).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Knot {
    /// Node h below, 0 to S − 2.
    pub h: usize,
    /// Weight w of node h + 1, 0 to 1.
    pub w: f32,
}

/// The log-scale scattering profile P̂_x of one pixel.
#[derive(Clone, Copy, Debug)]
pub struct LocalProfile<'a> {
    source: Source<'a>,
    /// S.
    samples: usize,
}

#[derive(Clone, Copy, Debug)]
enum Source<'a> {
    /// Σ t_k P̂_{b_k} of the first `count` base materials, with the first value of each profile.
    Blend { profiles: Profiles<'a>, starts: [usize; MAX_PER_PIXEL], ratios: [f32; MAX_PER_PIXEL], count: usize },
    /// The pixel's own values, one in every plane of `pixels`.
    Own { profiles: F32Le<'a>, pixel: usize, pixels: usize },
}

impl LocalProfile<'_> {
    /// P̂_x^h, natural log of mm⁻², of node `h` (eq. 4); zeros from S on.
    #[must_use]
    pub fn node(&self, h: usize) -> [f32; 3] {
        if h >= self.samples {
            return [0.0; 3];
        }
        match self.source {
            Source::Blend { profiles, starts, ratios, count } => {
                let mut sum = [0.0; 3];
                for (start, t) in starts.iter().zip(ratios).take(count) {
                    let p = profiles.rgb_at(row_major(h, RGB, *start));
                    for (sum, p) in sum.iter_mut().zip(p) {
                        *sum += t * p;
                    }
                }
                sum
            }
            Source::Own { profiles, pixel, pixels } => {
                let channel = |c: usize| {
                    let plane = row_major(h, RGB, c);
                    profiles.get(row_major(plane, pixels, pixel)).unwrap_or(0.0)
                };
                [channel(0), channel(1), channel(2)]
            }
        }
    }

    /// P̂_x(r) = (1 − w) P̂_x^h + w P̂_x^{h+1} (eq. 3), natural log of mm⁻².
    #[must_use]
    pub fn at(&self, knot: Knot) -> [f32; 3] {
        lerp(self.node(knot.h), self.node(knot.h.saturating_add(1)), knot.w)
    }
}

/// (1 − w) a + w b.
pub(super) fn lerp(a: [f32; 3], b: [f32; 3], w: f32) -> [f32; 3] {
    let [a0, a1, a2] = a;
    let [b0, b1, b2] = b;
    [a0 + w * (b0 - a0), a1 + w * (b1 - a1), a2 + w * (b2 - a2)]
}

impl BssrdfHeader {
    /// h and w of distance `r_mm`; `None` beyond r_max, where Rd is 0, and for NaN.
    #[must_use]
    pub fn knot(&self, r_mm: f32) -> Option<Knot> {
        if !(0.0..=self.r_max_mm).contains(&r_mm) {
            return None;
        }
        let intervals = self.samples.saturating_sub(1);
        let position = r_mm / self.r_max_mm * f32::from(intervals);
        // `as` saturates, and the last interval takes r_max itself.
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "0 ≤ position ≤ 4095; the integer part is wanted"
        )]
        let h = (position as u16).min(intervals.saturating_sub(1));
        Some(Knot { h: h.into(), w: position - f32::from(h) })
    }

    /// Distance in mm of two pixels `dx`, `dy` apart; `None` outside the window, where Rd is 0.
    #[must_use]
    pub fn distance_mm(&self, dx: i32, dy: i32) -> Option<f32> {
        let radius = u32::from(self.window_radius);
        let (dx, dy) = (dx.unsigned_abs(), dy.unsigned_abs());
        if dx > radius || dy > radius {
            return None;
        }
        // Both are at most 1,023, so that the squares are exact in f32.
        #[allow(clippy::cast_precision_loss, reason = "dx² + dy² < 2²⁴")]
        let r2 = dx.saturating_mul(dx).saturating_add(dy.saturating_mul(dy)) as f32;
        Some(libm::sqrtf(r2) * self.pitch_mm)
    }
}

impl<'a> Bssrdf<'a> {
    /// [`BssrdfHeader::knot`].
    #[must_use]
    pub fn knot(&self, r_mm: f32) -> Option<Knot> {
        self.header().knot(r_mm)
    }

    /// Profile P̂_x of the pixel at `x` = [column, row]; outside the patch the addressing mode decides.
    #[must_use]
    pub fn profile(&self, x: [i32; 2]) -> LocalProfile<'a> {
        let header = self.header();
        let [column, row] = x;
        let column = header.addressing.map(column, header.width) as usize;
        let row = header.addressing.map(row, header.height) as usize;
        let pixel = row_major(row, header.width as usize, column);
        let pixels = usize::try_from(header.pixels()).unwrap_or(usize::MAX);
        let source = match *self.model() {
            BssrdfModel::BaseMaterials(planes) => {
                let values = row_major(header.samples.into(), RGB, 0);
                let mixture = planes.mixtures.at(pixel, pixels);
                Source::Blend {
                    profiles: planes.profiles,
                    starts: mixture.bases.map(|index| row_major(index.into(), values, 0)),
                    ratios: mixture.ratios,
                    count: header.model.into(),
                }
            }
            BssrdfModel::PerPixel(planes) => Source::Own { profiles: planes.profiles, pixel, pixels },
        };
        LocalProfile { source, samples: header.samples.into() }
    }

    /// Rd = exp(½ (P̂_i + P̂_o)) in mm⁻² of two profiles at one distance (eq. 2).
    #[must_use]
    pub fn rd_at(&self, p_i: &LocalProfile<'_>, p_o: &LocalProfile<'_>, knot: Knot) -> [f32; 3] {
        let [a0, a1, a2] = p_i.at(knot);
        let [b0, b1, b2] = p_o.at(knot);
        [a0 + b0, a1 + b1, a2 + b2].map(|sum| libm::expf(0.5 * sum))
    }

    /// [`BssrdfHeader::distance_mm`].
    #[must_use]
    pub fn distance_mm(&self, dx: i32, dy: i32) -> Option<f32> {
        self.header().distance_mm(dx, dy)
    }

    /// Diffuse reflectance Rd(x_i, x_o) in mm⁻², linear Rec. 709, between pixels given as [column, row] (eq. 1).
    ///
    /// Finite and ≥ 0; symmetric; 0 outside the window and beyond r_max. Pixels may lie outside the patch: the
    /// addressing mode says what is there, and the distance is that of the coordinates as given.
    #[must_use]
    pub fn rd(&self, x_i: [i32; 2], x_o: [i32; 2]) -> [f32; 3] {
        let [xi, yi] = x_i;
        let [xo, yo] = x_o;
        let r_mm = self.distance_mm(xi.saturating_sub(xo), yi.saturating_sub(yo));
        match r_mm.and_then(|r_mm| self.knot(r_mm)) {
            Some(knot) => self.rd_at(&self.profile(x_i), &self.profile(x_o), knot),
            None => [0.0; 3],
        }
    }

    /// Diffuse albedo Σ Rd(x_i, x) pitch² over the window of `x`, dimensionless, linear Rec. 709 (section 4.1).
    #[must_use]
    pub fn albedo(&self, x: [i32; 2]) -> [f32; 3] {
        let radius = i32::from(self.header().window_radius);
        let [column, row] = x;
        let mut sum = [0.0_f32; 3];
        for dy in radius.saturating_neg()..=radius {
            for dx in radius.saturating_neg()..=radius {
                let x_i = [column.saturating_add(dx), row.saturating_add(dy)];
                for (sum, rd) in sum.iter_mut().zip(self.rd(x_i, x)) {
                    *sum += rd;
                }
            }
        }
        sum.map(|sum| sum * self.header().pitch_mm * self.header().pitch_mm)
    }
}
