//! Base scattering profiles at the distances of a window, for processors on which `exp` is slow.

use super::evaluate::lerp;
use super::exp2::exp2;
use super::layout::{BssrdfHeader, MODEL_PER_PIXEL};
use super::planes::{BssrdfModel, Mixture};
use super::reader::Bssrdf;
use crate::container::index::row_major;
use core::f32::consts::LOG2_E;
use heapless::Vec;

/// What stands where Rd is 0, beyond r_max, and where nodes are missing: no exponent is as low.
const DARK: f32 = f32::MIN;

/// Base scattering profiles at all distances that pixels of the window have, in memory of the caller's choice: [`ProfileTable::rd`] looks
/// values up, without interpolation, and takes powers of two from a table of 256 bytes instead of `exp`.
///
/// Room for `N` colours of 12 bytes. ½ P̂_b / ln 2 is stored for every base material b and distance √(dx² + dy²) · pitch,
/// 0 ≤ dy ≤ dx ≤ R. Exponents of Rd are linear in P̂ (Yatagawa et al. 2020, eq. 2-4), and so are mixtures of what was interpolated before.
///
/// Rd differs from [`Bssrdf::rd`] by rounding alone: relatively by at most 2 · 10⁻⁶ where profiles are above −8, and by 2 · 10⁻⁵ at the ends of their range of ±87.
#[derive(Clone, Debug)]
pub struct ProfileTable<const N: usize> {
    /// Shape `[M][place][rgb]`.
    values: Vec<[f32; 3], N>,
    /// Of the material whose nodes come.
    header: Option<BssrdfHeader>,
    /// The material and the node that come next, and the node before.
    next: (usize, u16),
    last: [f32; 3],
}

impl<const N: usize> Default for ProfileTable<N> {
    fn default() -> Self {
        Self::new()
    }
}

impl<const N: usize> ProfileTable<N> {
    /// Table of no material.
    #[must_use]
    pub const fn new() -> Self {
        Self { values: Vec::new(), header: None, next: (0, 0), last: [0.0; 3] }
    }

    /// Colours that a material takes, M (R + 1) (R + 2) / 2; `None` for per-pixel profiles, which have no base materials.
    #[must_use]
    pub fn colours(header: &BssrdfHeader) -> Option<usize> {
        if header.model == MODEL_PER_PIXEL {
            return None;
        }
        let materials = usize::try_from(header.base_materials).unwrap_or(usize::MAX);
        Some(materials.saturating_mul(places(header)))
    }

    /// Makes room for a material whose nodes [`Self::push`] brings; false, and a table of none, where `N` is less than
    /// [`Self::colours`], or there are none.
    pub fn begin(&mut self, header: &BssrdfHeader) -> bool {
        self.values.clear();
        (self.header, self.next, self.last) = (None, (0, 0), [0.0; 3]);
        let has_room = Self::colours(header).is_some_and(|colours| self.values.resize(colours, [DARK; 3]).is_ok());
        if has_room {
            self.header = Some(*header);
        }
        has_room
    }

    /// Takes the next node P̂_b^h of the base scattering profiles, in file order. Those beyond the last are ignored.
    pub fn push(&mut self, node: [f32; 3]) {
        let Some(header) = &self.header else { return };
        let (material, h) = self.next;
        let start = row_major(material, places(header), 0);
        let values = self.values.get_mut(start..).unwrap_or(&mut []);
        // What lies between the node before and this one.
        for (value, [dx, dy]) in values.iter_mut().zip(offsets(header)).filter(|_| h > 0) {
            match header.distance_mm(dx, dy).and_then(|r_mm| header.knot(r_mm)) {
                Some(knot) if knot.h.saturating_add(1) == h.into() => {
                    *value = lerp(self.last, node, knot.w).map(|p| 0.5 * LOG2_E * p);
                }
                _ => {}
            }
        }
        let after = h.saturating_add(1);
        self.next = if after < header.samples { (material, after) } else { (material.saturating_add(1), 0) };
        self.last = node;
    }

    /// All base materials of a file; false as [`Self::begin`].
    pub fn expand(&mut self, material: &Bssrdf<'_>) -> bool {
        let BssrdfModel::BaseMaterials(planes) = material.model() else { return false };
        let header = material.header();
        if !self.begin(header) {
            return false;
        }
        let materials = usize::try_from(header.base_materials).unwrap_or(0);
        for node in 0..materials.saturating_mul(header.samples.into()) {
            self.push(planes.profiles.rgb_at(row_major(node, 3, 0)));
        }
        true
    }

    /// Diffuse reflectance Rd in mm⁻², linear Rec. 709, between pixels of two mixtures, `dx` and `dy` pixels apart.
    ///
    /// Finite and ≥ 0; symmetric; 0 outside the window, beyond r_max, and of a table that has not all its nodes where these are missing.
    #[must_use]
    pub fn rd(&self, x_i: &Mixture, x_o: &Mixture, dx: i32, dy: i32) -> [f32; 3] {
        let Some(header) = &self.header else { return [0.0; 3] };
        let (dx, dy) = (dx.unsigned_abs(), dy.unsigned_abs());
        if dx.max(dy) > header.window_radius.into() {
            return [0.0; 3];
        }
        let place = place(dx.max(dy), dx.min(dy));
        let (places, count) = (places(header), usize::from(header.model));
        let exponents = |pixel: &Mixture| {
            let mut sum = [0.0; 3];
            for (base, t) in pixel.bases.iter().zip(pixel.ratios).take(count).filter(|(_, t)| *t > 0.0) {
                let value = *self.values.get(row_major((*base).into(), places, place))?;
                if value == [DARK; 3] {
                    return None;
                }
                for (sum, value) in sum.iter_mut().zip(value) {
                    *sum += t * value;
                }
            }
            Some(sum)
        };
        match (exponents(x_i), exponents(x_o)) {
            (Some([a0, a1, a2]), Some([b0, b1, b2])) => [a0 + b0, a1 + b1, a2 + b2].map(exp2),
            _ => [0.0; 3],
        }
    }
}

/// Number of the place of pixels `dx` and `dy` apart, dx ≥ dy.
fn place(dx: u32, dy: u32) -> usize {
    let row = dx.wrapping_mul(dx.wrapping_add(1)) >> 1;
    row.wrapping_add(dy) as usize
}

/// Places of a window.
fn places(header: &BssrdfHeader) -> usize {
    place(u32::from(header.window_radius).wrapping_add(1), 0)
}

/// dx and dy of all places in order.
fn offsets(header: &BssrdfHeader) -> impl Iterator<Item = [i32; 2]> {
    (0..=i32::from(header.window_radius)).flat_map(|dx| (0..=dx).map(move |dy| [dx, dy]))
}
