//! The borrowed planes of a checked file.

use super::layout::{MAX_CODED_RATIO, MAX_PAIRS, MAX_PER_PIXEL};
use crate::container::bytes::{F16Le, F32Le, U16Le};
use crate::container::index::row_major;

/// The planes of a file, by model.
#[derive(Clone, Copy, Debug)]
pub enum BssrdfModel<'a> {
    /// K-BMPP (Yatagawa et al. 2020, eq. 4).
    BaseMaterials(BaseMaterials<'a>),
    /// A profile for every pixel (Song et al. 2009).
    PerPixel(PerPixelProfiles<'a>),
}

/// Base scattering profiles, and what every pixel makes of them.
#[derive(Clone, Copy, Debug)]
pub struct BaseMaterials<'a> {
    /// Log-scale base scattering profiles P̂_b^h.
    ///
    /// Shape `[M][S][rgb]`; natural log of mm⁻², linear Rec. 709, in ±87.
    pub profiles: Profiles<'a>,
    /// Base materials and mixture ratios of the pixels; each plane is one texture as it stands.
    pub mixtures: Mixtures<'a>,
}

/// Log-scale profiles in one of two precisions.
#[derive(Clone, Copy, Debug)]
pub enum Profiles<'a> {
    /// Single precision.
    F32(F32Le<'a>),
    /// Half precision: eleven bits, for values that are seldom below −16 an error of 0.4 % of Rd.
    F16(F16Le<'a>),
}

impl Profiles<'_> {
    /// Three consecutive values from `index`, zero where there are none.
    #[must_use]
    pub fn rgb_at(self, index: usize) -> [f32; 3] {
        match self {
            Self::F32(values) => values.rgb_at(index),
            Self::F16(values) => values.rgb_at(index),
        }
    }
}

/// Base materials b_k and ratios t_k of all pixels. Indices are less than M, ratios in 0 to 1.
#[derive(Clone, Copy, Debug)]
pub enum Mixtures<'a> {
    /// K = 1, M ≤ 256: b, shape `[height][width]`.
    One(&'a [u8]),
    /// K = 1, M > 256: likewise.
    OneOfMany(U16Le<'a>),
    /// K = 2: 48 bits per pixel.
    Two {
        /// t of the first base material, 1 − t of the second; shape `[height][width]`.
        ratios: F32Le<'a>,
        /// b₁, b₂; shape `[height][width]`.
        indices: &'a [[u8; 2]],
    },
    /// K = 2 with t in 8 bits: 24 bits per pixel.
    TwoSmall {
        /// 255 t; shape `[height][width]`.
        ratios: &'a [u8],
        /// b₁, b₂; shape `[height][width]`.
        indices: &'a [[u8; 2]],
    },
    /// K = 2 with a palette: 16 bits per pixel.
    Palette {
        /// b₁, b₂ of every pair; at most 2,048.
        pairs: &'a [[u8; 2]],
        /// Number of the pair in the lower 11 bits, 31 t in the upper 5; shape `[height][width]`.
        codes: U16Le<'a>,
    },
    /// K = 3 or 5: 40 K bits per pixel.
    Several {
        /// t_k, adding up to 1; shape `[K][height][width]`.
        ratios: F32Le<'a>,
        /// b_k; shape `[K][height][width]`.
        indices: &'a [u8],
        /// K.
        count: usize,
    },
}

/// Pair number and 5-bit ratio of a palette code.
pub(crate) fn split_code(code: u16) -> (u16, u16) {
    (code % MAX_PAIRS, code / MAX_PAIRS)
}

/// What one pixel is made of: P̂_x = Σ t_k P̂_{b_k}; entries beyond K have the ratio 0.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Mixture {
    /// b_k.
    pub bases: [u16; MAX_PER_PIXEL],
    /// t_k.
    pub ratios: [f32; MAX_PER_PIXEL],
}

impl Mixture {
    /// t of b₁ and 1 − t of b₂.
    fn of_two([b1, b2]: [u8; 2], t: f32) -> Self {
        Self { bases: [b1.into(), b2.into(), 0, 0, 0], ratios: [t, 1.0 - t, 0.0, 0.0, 0.0] }
    }

    fn of_one(base: u16) -> Self {
        Self { bases: [base, 0, 0, 0, 0], ratios: [1.0, 0.0, 0.0, 0.0, 0.0] }
    }
}

impl Mixtures<'_> {
    /// The mixture of pixel number y · width + x; zeros beyond the last one. `pixels` is N.
    #[must_use]
    pub fn at(self, pixel: usize, pixels: usize) -> Mixture {
        let none = Mixture::default();
        match self {
            Self::One(indices) => indices.get(pixel).map_or(none, |&base| Mixture::of_one(base.into())),
            Self::OneOfMany(indices) => indices.get(pixel).map_or(none, Mixture::of_one),
            Self::Two { ratios, indices } => {
                indices.get(pixel).zip(ratios.get(pixel)).map_or(none, |(&pair, t)| Mixture::of_two(pair, t))
            }
            Self::TwoSmall { ratios, indices } => indices
                .get(pixel)
                .zip(ratios.get(pixel))
                .map_or(none, |(&pair, &t)| Mixture::of_two(pair, f32::from(t) / 255.0)),
            Self::Palette { pairs, codes } => {
                let (pair, t) = split_code(codes.get(pixel).unwrap_or(0));
                let t = f32::from(t) / f32::from(MAX_CODED_RATIO);
                pairs.get(usize::from(pair)).map_or(none, |&pair| Mixture::of_two(pair, t))
            }
            Self::Several { ratios, indices, count } => {
                let mut mixture = none;
                let slots = mixture.bases.iter_mut().zip(&mut mixture.ratios);
                for (k, (base, t)) in slots.enumerate().take(count) {
                    let at = row_major(k, pixels, pixel);
                    *base = indices.get(at).copied().unwrap_or(0).into();
                    *t = ratios.get(at).unwrap_or(0.0);
                }
                mixture
            }
        }
    }
}

/// The one section of per-pixel profiles.
#[derive(Clone, Copy, Debug)]
pub struct PerPixelProfiles<'a> {
    /// Log-scale local scattering profiles P̂_x^h.
    ///
    /// Shape `[S][rgb][height][width]`; natural log of mm⁻², linear Rec. 709, in ±87.
    pub profiles: F32Le<'a>,
}
