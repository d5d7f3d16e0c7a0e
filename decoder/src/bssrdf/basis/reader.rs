//! Reads and checks the separable basis of a file once; afterwards its numbers are borrowed and nothing can fail.

use super::cascade::Cascade;
use super::layout::{BasisSize, HEADER_BYTES, MAX_PROJECTION, MAX_STEP, MAX_WEIGHT, WIDTHS};
use crate::bssrdf::evaluate::LocalProfile;
use crate::container::bytes::F32Le;
use crate::container::index::row_major;
use crate::container::sections::SectionBytes;
use crate::error::ReadError;

/// Colour channels.
const RGB: usize = 3;

/// Separable basis of a file: Rd as a sum of products of coefficients per pixel and shared Gaussians.
///
/// c_l(x) = Σ_h d_lh exp(½ P̂_x^h), and with light E the exitance is M(x) = Σ_m c_m(x) Σ_l Σ_a w_lma (G_a * c_l E)(x); all per
/// colour channel, linear Rec. 709.
#[derive(Clone, Copy, Debug)]
pub struct SeparableBasis<'a> {
    size: BasisSize,
    /// S.
    samples: usize,
    /// σ_a in pixels, shape `[A]`.
    sigmas: F32Le<'a>,
    /// w, shape `[pair][A][rgb]`.
    weights: F32Le<'a>,
    /// d in mm, shape `[L][S][rgb]`.
    projection: F32Le<'a>,
}

impl<'a> SeparableBasis<'a> {
    /// Reads and checks the section; profiles have `samples` nodes.
    pub(crate) fn parse(section: SectionBytes<'a>, samples: u16) -> Result<Self, ReadError> {
        let size = BasisSize::parse(section)?;
        let section = section.sized(size.section_bytes(samples))?.from(HEADER_BYTES);
        let weights_at = size.gaussians;
        let projection_at = row_major(size.pairs(), row_major(size.gaussians, RGB, 0), weights_at);
        let from = |item: usize| section.from(row_major(item, size_of::<f32>(), 0));
        let numbers = |item: usize, count: usize| {
            let bytes = from(item).bytes;
            F32Le::new(bytes.get(..row_major(count, size_of::<f32>(), 0)).unwrap_or(bytes))
        };
        let samples = usize::from(samples);
        let basis = Self {
            size,
            samples,
            sigmas: numbers(0, size.gaussians),
            weights: numbers(weights_at, projection_at.saturating_sub(weights_at)),
            projection: F32Le::new(from(projection_at).bytes),
        };
        check_widths(SectionBytes { bytes: basis.sigmas.as_bytes(), ..section })?;
        check_magnitudes(SectionBytes { bytes: basis.weights.as_bytes(), ..from(weights_at) }, MAX_WEIGHT)?;
        check_magnitudes(from(projection_at), MAX_PROJECTION)?;
        Ok(basis)
    }

    /// L and A.
    #[must_use]
    pub fn size(&self) -> BasisSize {
        self.size
    }

    /// Standard deviations σ_a in pixels, 0.125 to 1,023, by rising width; shape `[A]`.
    pub fn sigmas(&self) -> impl Iterator<Item = f32> + 'a {
        self.sigmas.iter()
    }

    /// Stages of the blurs that the weights are for.
    #[must_use]
    pub fn cascade(&self) -> Cascade {
        Cascade::new(self.sigmas())
    }

    /// Weights w_lma of Gaussian number `a`, dimensionless, −10⁶ to 10⁶; symmetric in l and m. Zeros out of range.
    #[must_use]
    pub fn weight(&self, l: usize, m: usize, a: usize) -> [f32; 3] {
        let BasisSize { terms, gaussians } = self.size;
        if l >= terms || m >= terms || a >= gaussians {
            return [0.0; 3];
        }
        self.weights.rgb_at(row_major(row_major(self.size.pair(l, m), gaussians, a), RGB, 0))
    }

    /// Factors d_lh in mm of node `h`, −10¹⁵ to 10¹⁵; zeros out of range.
    #[must_use]
    pub fn projection(&self, l: usize, h: usize) -> [f32; 3] {
        if l >= self.size.terms || h >= self.samples {
            return [0.0; 3];
        }
        self.projection.rgb_at(row_major(row_major(l, self.samples, h), RGB, 0))
    }

    /// Coefficient c_l = Σ_h d_lh exp(½ P̂^h) of a pixel by its profile; dimensionless, finite.
    #[must_use]
    pub fn coefficient(&self, l: usize, profile: &LocalProfile<'_>) -> [f32; 3] {
        let mut sum = [0.0; 3];
        for h in 0..self.samples {
            for ((sum, d), p) in sum.iter_mut().zip(self.projection(l, h)).zip(profile.node(h)) {
                *sum += d * libm::expf(0.5 * p);
            }
        }
        sum
    }
}

/// Refuses widths that do not rise, by steps that keep the taps of a blur few.
pub(super) fn check_widths(section: SectionBytes<'_>) -> Result<(), ReadError> {
    let mut range = [WIDTHS[0], MAX_STEP];
    for (a, sigma) in F32Le::new(section.bytes).iter().enumerate() {
        section.origin.at_item(a, size_of::<f32>()).number(0, sigma, range)?;
        range = [sigma, (MAX_STEP * sigma).min(WIDTHS[1])];
    }
    Ok(())
}

/// Refuses numbers of larger magnitudes than `most`.
#[inline(never)]
pub(super) fn check_magnitudes(section: SectionBytes<'_>, most: f32) -> Result<(), ReadError> {
    for (k, value) in F32Le::new(section.bytes).iter().enumerate() {
        section.origin.at_item(k, size_of::<f32>()).number(0, value, [-most, most])?;
    }
    Ok(())
}
