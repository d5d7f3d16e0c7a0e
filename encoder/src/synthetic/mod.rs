//! Materials without any meaning, made at once: for timing, and for tests that need no physics.

mod factored;
mod nested;

use subsurf_decoder::bssrdf::layout::{MODEL_2BMPP, MODEL_PER_PIXEL};
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, Coding, Mixture};
use subsurf_decoder::{Bssrdf, Section};

use crate::bssrdf::{mixtures, profiles, write_file};
use crate::math::parallel;
pub use factored::factored;
pub use nested::NestedShape;

/// Size of a synthetic material.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Shape {
    /// Pixels in x and y.
    pub size: [u32; 2],
    /// Radius of the window in pixels, R.
    pub radius: u16,
    /// Nodes of a profile, S.
    pub samples: u16,
    /// Base materials, M.
    pub base_materials: u32,
    /// What lies beyond the border.
    pub addressing: Addressing,
}

/// A number in 0 .. 1 that looks random and depends on `n` alone.
#[must_use]
pub fn unit(n: u32) -> f32 {
    // Two rounds of multiply and shift spread the bits of n; 24 of them make a float.
    let bits = (n ^ (n >> 16)).wrapping_mul(0x7FEB_352D);
    let bits = (bits ^ (bits >> 15)).wrapping_mul(0x846C_A68B) >> 8;
    #[allow(clippy::cast_precision_loss, reason = "24 bits fit")]
    let bits = bits as f32;
    bits / 16_777_216.0
}

impl Shape {
    /// Header of the 2-BMPP file of this shape: 0.5 mm pitch, nodes up to the window's corner, η = 1.4.
    #[must_use]
    pub fn header(&self) -> BssrdfHeader {
        let pitch_mm = 0.5;
        BssrdfHeader {
            model: MODEL_2BMPP,
            coding: Coding::Exact,
            addressing: self.addressing,
            width: self.size[0],
            height: self.size[1],
            window_radius: self.radius,
            samples: self.samples,
            base_materials: self.base_materials,
            pitch_mm,
            r_max_mm: f32::from(self.radius.max(1)) * std::f32::consts::SQRT_2 * pitch_mm * 1.000_01,
            eta: 1.4,
        }
    }

    /// Log-scale profile number `k` at node h: falls as light does in a medium, no two alike.
    fn log_profile(&self, k: u32, h: u16, c: u32) -> f32 {
        let header = self.header();
        let r_mm = f32::from(h) * header.r_max_mm / f32::from(self.samples - 1);
        let brightness = -1.5 + 0.8 * unit(3 * k + c);
        let decay = 0.6 + 0.8 * unit(0x1000_0000 + 3 * k + c);
        brightness - decay * r_mm - (1.0 + r_mm * r_mm).ln()
    }

    /// A 2-BMPP file whose pixels blend its base materials at random.
    #[must_use]
    pub fn bmpp(&self) -> Vec<u8> {
        self.k_bmpp(MODEL_2BMPP, Coding::Exact, false)
    }

    /// A K-BMPP file of `k` base materials per pixel, with a coding of its own, and with profiles in half precision if
    /// asked for.
    #[must_use]
    pub fn k_bmpp(&self, k: u8, coding: Coding, half_profiles: bool) -> Vec<u8> {
        let header = BssrdfHeader { model: k, coding, ..self.header() };
        let nodes = || (0..self.samples).flat_map(|h| (0..3).map(move |c| (h, c)));
        let values = (0..self.base_materials).flat_map(|b| nodes().map(move |(h, c)| (b, h, c)));
        let values = values.map(|(b, h, c)| self.log_profile(b, h, c));
        let pixels = 0..self.size[0] * self.size[1];
        let blends: Vec<Mixture> = pixels.map(|pixel| self.mixture(pixel, k.into())).collect();
        let mut sections = vec![profiles(values, half_profiles)];
        sections.extend(mixtures(&header, &blends));
        write_file(&header, &sections)
    }

    /// `k` base materials at random; what a ratio leaves of 1 is for the next, and the last has the rest.
    fn mixture(&self, pixel: u32, k: usize) -> Mixture {
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            clippy::cast_precision_loss,
            reason = "less than M, which is at most 65,536"
        )]
        let base = |n: u32| (unit(n) * self.base_materials as f32).min(self.base_materials as f32 - 1.0) as u16;
        let mut mixture = Mixture::default();
        let mut rest = 1.0;
        for (at, part) in (0..k).zip(0_u32..) {
            mixture.bases[at] = base((0x3000_0000 + 0x1000_0000 * part) + pixel);
            let share = if at + 1 == k { 1.0 } else { unit(0x2000_0000 + 0x0100_0000 * part + pixel) };
            mixture.ratios[at] = rest * share;
            rest *= 1.0 - share;
        }
        mixture
    }

    /// A file of per-pixel profiles.
    #[must_use]
    pub fn per_pixel(&self) -> Vec<u8> {
        let header = BssrdfHeader { model: MODEL_PER_PIXEL, base_materials: 0, ..self.header() };
        let planes = (0..self.samples).flat_map(|h| (0..3).map(move |c| (h, c)));
        let values = planes.flat_map(|(h, c)| (0..self.size[0] * self.size[1]).map(move |pixel| (pixel, h, c)));
        let values = values.flat_map(|(pixel, h, c)| self.log_profile(pixel, h, c).to_le_bytes()).collect();
        write_file(&header, &[(Section::LocalProfiles, values)])
    }
}

/// The entries of one row of windows that a material stands for, `[x][dy][dx][rgb]` in mm⁻²; beyond the border of a patch
/// that clamps they are NaN.
#[must_use]
pub fn capture_row(material: &Bssrdf<'_>, y: u32) -> Vec<f32> {
    let header = material.header();
    let radius = i32::from(header.window_radius);
    let window = |x: u32| -> Vec<[f32; 3]> {
        let from = [x.cast_signed(), y.cast_signed()];
        let steps = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy]));
        let entry = |[dx, dy]: [i32; 2]| {
            let to = [from[0] + dx, from[1] + dy];
            let same = |k: i32, n: u32| header.addressing.map(k, n).cast_signed() == k;
            let inside =
                header.addressing != Addressing::Clamp || (same(to[0], header.width) && same(to[1], header.height));
            if inside { material.rd(from, to) } else { [f32::NAN; 3] }
        };
        steps.map(entry).collect()
    };
    let columns: Vec<u32> = (0..header.width).collect();
    parallel::map(columns.len(), |k| window(columns[k])).concat().into_flattened()
}
