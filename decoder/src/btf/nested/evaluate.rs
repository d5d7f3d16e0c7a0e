//! Values of apparent BRDFs by chained look-ups (Havran et al. 2010, eq. 4), linear between the nodes of all four axes
//! (their fig. 6).

use super::codebooks::NestedCodebooks;
use super::scale::Scale;
use super::stage::Stage;
use crate::btf::coord::{GridCoord, LerpCoord};

/// One of the four nodes of view around coordinates.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner {
    /// Row of M, or of P2 in later stages.
    pub(super) row: u32,
    /// c_P6 c_P4 c_P3
    pub(super) scale: Scale,
    /// The corners' weights add up to 1.
    pub(super) weight: f32,
}

/// A number for each node of light around coordinates, `[α][β]`.
type Lights = [f32; 4];

/// Weights of the four nodes of light.
fn light_weights(coord: &GridCoord) -> Lights {
    let ([a0, a1], [b0, b1]) = (coord.alpha.weights(), coord.beta.weights());
    [a0 * b0, a0 * b1, a1 * b0, a1 * b1]
}

fn sum([a, b, c, d]: Lights) -> f32 {
    (a + b) + (c + d)
}

/// Sums over the nodes of view.
fn total([a, b, c, d]: &[Lights; 4]) -> Lights {
    let add = |[a0, a1, a2, a3]: Lights, [b0, b1, b2, b3]: Lights| [a0 + b0, a1 + b1, a2 + b2, a3 + b3];
    add(add(*a, *b), add(*c, *d))
}

impl NestedCodebooks<'_> {
    /// Luma and chroma of texel `texel` without the fading of low lights.
    pub(crate) fn channels(&self, texel: u32, coord: &GridCoord) -> [f32; 3] {
        let (first, others) = self.stages();
        let weights = light_weights(coord);
        let (p4, c6, tint) = first.texels.one_and_rest(texel, self.tint_mask());
        let [a, b, c, d] = first.corners::<false>(p4, c6, coord.phi, coord.theta);
        let rows = (self.merged(a.row), self.merged(b.row), self.merged(c.row), self.merged(d.row));
        let ((p2_a, i2_a), (p2_b, i2_b), (p2_c, i2_c), (p2_d, i2_d)) = rows;
        // Weights · Y of the nodes of light, for each node of view.
        let luma = |p2: u32, corner: &Corner| first.luma::<false>(p2, corner, coord, weights);
        let lumas = [luma(p2_a, &a), luma(p2_b, &b), luma(p2_c, &c), luma(p2_d, &d)];
        let first_luma = sum(total(&lumas)) * (1.0 / 255.0);
        let mut luma = first_luma;
        for stage in others {
            luma += stage.later_luma(texel, coord, weights);
        }
        let hues = [i2_a, i2_b, i2_c, i2_d];
        let ([first_a, first_b], [step_a, step_b]) = (self.chroma_first(), self.chroma_step());
        let [tint_a, tint_b] = self.tint(tint);
        if self.is_relative() {
            // The brighter of the nodes count for more.
            let [code_a, code_b] = self.chroma(hues, &lumas, coord);
            let ratio = if first_luma > 0.0 { 1.0 / (255.0 * first_luma) } else { 0.0 };
            let a = first_a + step_a * (code_a * ratio + tint_a);
            let b = first_b + step_b * (code_b * ratio + tint_b);
            [luma, luma * a, luma * b]
        } else {
            let share = |corner: Corner| weights.map(|weight| corner.weight * weight);
            let [code_a, code_b] = self.chroma(hues, &[share(a), share(b), share(c), share(d)], coord);
            [luma, first_a + step_a * (code_a + tint_a), first_b + step_b * (code_b + tint_b)]
        }
    }

    /// Codes of chroma of four rows of I2, each times its shares.
    #[inline]
    fn chroma(&self, [i2_a, i2_b, i2_c, i2_d]: [u32; 4], shares: &[Lights; 4], coord: &GridCoord) -> [f32; 2] {
        let at = [self.i2().before(coord.first_alpha()), self.i1().before(coord.first_beta())];
        let mut sums = [0.0; 4];
        if i2_a == i2_b && i2_a == i2_c && i2_a == i2_d {
            // Neighbours of one colour are looked up once.
            self.add_chroma(i2_a, total(shares), at, &mut sums);
        } else {
            let [a, b, c, d] = *shares;
            self.add_chroma(i2_a, a, at, &mut sums);
            self.add_chroma(i2_b, b, at, &mut sums);
            self.add_chroma(i2_c, c, at, &mut sums);
            self.add_chroma(i2_d, d, at, &mut sums);
        }
        let [a0, b0, a1, b1] = sums;
        [a0 + a1, b0 + b1]
    }

    /// Both channels at both β in one go; `at` are the offsets in rows of I2 and I1.
    #[inline(always)]
    fn add_chroma(&self, i2: u32, shares: Lights, at: [usize; 2], sums: &mut [f32; 4]) {
        let [at_alpha, at_beta] = at;
        let [low, high] = self.i2().two(i2, at_alpha);
        let ([c0, c1], [c2, c3]) = (self.i1().two(low, at_beta), self.i1().two(high, at_beta));
        let ([a0, b0], [a1, b1]) = (self.colour(c0), self.colour(c1));
        let ([a2, b2], [a3, b3]) = (self.colour(c2), self.colour(c3));
        let [s0, s1, s2, s3] = shares;
        let [sum_a0, sum_b0, sum_a1, sum_b1] = *sums;
        let code = |code: u8| f32::from(code);
        *sums = [
            sum_a0 + s0 * code(a0) + s2 * code(a2),
            sum_b0 + s0 * code(b0) + s2 * code(b2),
            sum_a1 + s1 * code(a1) + s3 * code(a3),
            sum_b1 + s1 * code(b1) + s3 * code(b3),
        ];
    }
}

impl Stage<'_> {
    /// The four nodes of view around coordinates, of row `p4` of P4 times c_P6.
    #[inline(always)]
    pub(super) fn corners<const SIGNED: bool>(
        &self,
        p4: u32,
        c6: Scale,
        phi: LerpCoord,
        theta: LerpCoord,
    ) -> [Corner; 4] {
        let ([phi_low, phi_high], [theta_low, theta_high]) = (phi.weights(), theta.weights());
        let [at_theta, _] = theta.nodes;
        let at_theta = self.p3.before(at_theta);
        // P3 at φ_v of P4, times c_P6 c_P4.
        let pair = |phi: u32, weight: f32| {
            let (p3, c4) = self.p4.one::<SIGNED>(p4, self.p4.before(phi));
            let scale = c6.times(c4);
            let [(low, c_low), (high, c_high)] = self.p3.two::<SIGNED>(p3, at_theta);
            let low = Corner { row: low, scale: scale.times(c_low), weight: weight * theta_low };
            (low, Corner { row: high, scale: scale.times(c_high), weight: weight * theta_high })
        };
        let [phi, next_phi] = phi.nodes;
        let ((a, b), (c, d)) = (pair(phi, phi_low), pair(next_phi, phi_high));
        [a, b, c, d]
    }

    /// Luma of the nodes of light in steps of a code, of row `p2` of P2, times all weights.
    #[inline(always)]
    fn luma<const SIGNED: bool>(&self, p2: u32, corner: &Corner, coord: &GridCoord, weights: Lights) -> Lights {
        let [(low, c_low), (high, c_high)] = self.p2.two::<SIGNED>(p2, coord.first_alpha());
        let beta = coord.first_beta();
        let (([v0, v1], s_low), ([v2, v3], s_high)) = (self.slice_pair(low, beta), self.slice_pair(high, beta));
        let scale = |c2: Scale, slice: Scale| corner.weight * corner.scale.times(c2).times(slice).value();
        let (low, high) = (scale(c_low, s_low), scale(c_high, s_high));
        let code = |code: u8| if SIGNED { f32::from(code.cast_signed()) } else { f32::from(code) };
        let [w0, w1, w2, w3] = weights;
        [low * code(v0) * w0, low * code(v1) * w1, high * code(v2) * w2, high * code(v3) * w3]
    }

    /// Luma that a later stage adds.
    fn later_luma(&self, texel: u32, coord: &GridCoord, weights: Lights) -> f32 {
        if self.is_signed {
            self.all_luma::<true>(texel, coord, weights) * (1.0 / 127.0)
        } else {
            self.all_luma::<false>(texel, coord, weights) * (1.0 / 255.0)
        }
    }

    /// Luma of a stage whose P3 leads to P2, in steps of a code.
    #[inline]
    fn all_luma<const SIGNED: bool>(&self, texel: u32, coord: &GridCoord, weights: Lights) -> f32 {
        let (p4, c6) = self.texels.one::<SIGNED>(texel, 0);
        let [a, b, c, d] = self.corners::<SIGNED>(p4, c6, coord.phi, coord.theta);
        let luma = |corner: &Corner| self.luma::<SIGNED>(corner.row, corner, coord, weights);
        sum(total(&[luma(&a), luma(&b), luma(&c), luma(&d)]))
    }
}
