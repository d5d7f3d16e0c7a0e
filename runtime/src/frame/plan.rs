//! Sizes of the buffers of a frame, and the bytes that they take, before any of them is made.

use crate::error::{Error, Result};

/// Sizes of everything that a frame allocates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Texels to a side of each light's view.
    pub light_texels: u32,
    /// Number of lights with a view: those whose shadows are drawn.
    pub lights: u32,
    /// Lights' views in a row of their textures, at least 1: all of them where textures may be as wide.
    pub light_columns: u32,
    /// Pixels of the picture to a side of a texel of the maps that scatter light, at least 1.
    pub divisor: f32,
    /// Width and height of the maps of separable blurs in texels: they lie over what objects cover, and are coarser than
    /// `divisor` says only where that is more than they hold.
    pub blur_size: [u32; 2],
    /// Whether lights' views have coarser levels, from which splats are drawn.
    pub has_light_levels: bool,
}

/// Largest divisor whose maps still look like the scene.
const LARGEST_DIVISOR: f32 = 4.0;
/// Fewest texels to a side of shadow maps that still look like the scene.
pub(crate) const LEAST_LIGHT_TEXELS: u32 = 128;

impl Plan {
    /// Width and height of the maps in texels.
    #[must_use]
    pub fn map_size(&self) -> [u32; 2] {
        #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "less than the picture has")]
        self.size.map(|side| ((side as f32 / self.divisor).ceil() as u32).clamp(1, side.max(1)))
    }

    /// Mipmap levels of lights' views.
    pub(crate) fn light_levels(&self) -> u32 {
        if self.has_light_levels && self.lights > 0 { self.light_texels.ilog2() } else { 1 }
    }

    /// Width and height of the textures of lights' views in texels: a square tile for each light, row by row. Where there is none, a
    /// texel is bound.
    #[must_use]
    pub fn light_size(&self) -> [u32; 2] {
        if self.lights == 0 {
            return [1; 2];
        }
        [self.light_columns, self.lights.div_ceil(self.light_columns)].map(|tiles| self.light_texels * tiles)
    }

    /// Column and row of the first texel of the tile of a light.
    pub(crate) fn tile(&self, number: u32) -> [u32; 2] {
        [number % self.light_columns, number / self.light_columns].map(|tiles| self.light_texels * tiles)
    }

    /// Texels to a side of each light's view, `wanted` or fewer, and views in a row, where textures have at most `most` texels to a
    /// side.
    pub(crate) fn tiles(lights: u32, wanted: u32, most: u32) -> [u32; 2] {
        let lights = lights.max(1);
        let mut texels = wanted.min(1 << most.max(1).ilog2());
        // In as few rows as there can be, and not too many of them.
        while (most / texels).pow(2) < lights {
            texels /= 2;
        }
        [texels, lights.div_ceil(lights.div_ceil(most / texels))]
    }

    /// Next cheaper plan, if there is one.
    fn cheaper(self) -> Option<Self> {
        // What is seen least goes first.
        if self.light_texels > 2 * LEAST_LIGHT_TEXELS {
            return Some(Self { light_texels: self.light_texels / 2, ..self });
        }
        if self.divisor < LARGEST_DIVISOR {
            let divisor = (self.divisor + 0.5).min(LARGEST_DIVISOR);
            let blur_size = self.blur_size.map(|side| (side * 4 / 5).max(1));
            return Some(Self { divisor, blur_size, ..self });
        }
        let light_texels = self.light_texels / 2;
        (light_texels >= LEAST_LIGHT_TEXELS).then_some(Self { light_texels, ..self })
    }

    /// Best plan that fits, when `used` bytes are taken already and a plan takes what `bytes` says.
    ///
    /// # Errors
    /// [`Error::OverBudget`] if the cheapest does not fit.
    pub(crate) fn within(self, budget: Option<u64>, used: u64, bytes: impl Fn(&Self) -> u64) -> Result<Self> {
        let Some(budget_bytes) = budget else {
            return Ok(self);
        };
        let mut plan = self;
        loop {
            let need_bytes = used + bytes(&plan);
            if need_bytes <= budget_bytes {
                return Ok(plan);
            }
            plan = plan.cheaper().ok_or(Error::OverBudget { need_bytes, budget_bytes })?;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tiles_lie_in_as_few_rows_as_textures_are_wide() {
        for ((lights, wanted, most), expected) in [
            ((0, 512, 2_048), [512, 1]),
            ((1, 512, 2_048), [512, 1]),
            ((4, 512, 2_048), [512, 4]),
            // Two rows of three, in which one is left.
            ((5, 512, 2_048), [512, 3]),
            ((8, 512, 2_048), [512, 4]),
            ((8, 512, 16_384), [512, 8]),
            ((8, 1_024, 2_048), [512, 4]),
            ((2, 2_048, 2_048), [1_024, 2]),
        ] {
            assert_eq!(Plan::tiles(lights, wanted, most), expected, "{lights} of {wanted}, {most}");
        }
    }

    #[test]
    fn plans_shrink_until_they_fit_or_nothing_is_left() {
        let plan = Plan {
            size: [1280, 720],
            light_texels: 512,
            lights: 1,
            light_columns: 1,
            divisor: 1.0,
            blur_size: [1280, 720],
            has_light_levels: false,
        };
        let bytes = |plan: &Plan| u64::from(plan.light_texels).pow(2) * 16 + u64::from(plan.map_size()[0]) * 720;
        assert_eq!(plan.within(None, 0, bytes).unwrap(), plan);
        assert_eq!(plan.within(Some(1 << 30), 0, bytes).unwrap(), plan);
        let smaller = plan.within(Some(bytes(&plan) - 1), 0, bytes).unwrap();
        assert!(bytes(&smaller) < bytes(&plan), "{smaller:?}");
        assert!(plan.within(Some(bytes(&plan)), 1 << 20, bytes).unwrap() != plan, "what is used counts");
        match plan.within(Some(1000), 0, bytes) {
            Err(Error::OverBudget { need_bytes, budget_bytes: 1000 }) => assert!(need_bytes > 1000, "{need_bytes}"),
            other => panic!("{other:?}"),
        }
    }
}
