//! Sizes of the buffers of a frame, and the bytes that they take, before any of them is made.

use subsurf_scene::View;

use crate::error::{Error, Result};

/// Sizes of everything that a frame allocates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Plan {
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Texels to a side of each light's view.
    pub light_texels: u32,
    /// Number of lights with a view: those whose shadows are drawn.
    pub lights: u32,
    /// Pixels of the picture to a side of a texel of the maps that scatter light.
    pub divisor: u32,
    /// Whether lights' views have coarser levels, from which splats are drawn.
    pub has_light_levels: bool,
}

/// Largest divisor whose maps still look like the scene.
const LARGEST_DIVISOR: u32 = 4;
/// Fewest texels to a side of shadow maps that still look like the scene.
pub(crate) const LEAST_LIGHT_TEXELS: u32 = 128;

impl Plan {
    /// Width and height of the maps in texels.
    #[must_use]
    pub fn map_size(&self) -> [u32; 2] {
        self.size.map(|side| side.div_ceil(self.divisor).max(1))
    }

    /// Texels of the maps that a length spans which is as long as it is far from the eye, along rows and columns.
    pub(crate) fn texels_per_tangent(&self, view: &View) -> [f32; 2] {
        #[allow(clippy::cast_precision_loss, reason = "pictures are a few thousand pixels wide")]
        let size = self.map_size().map(|side| side as f32);
        let focal = view.focal();
        [0.5 * size[0] * focal.x, 0.5 * size[1] * focal.y]
    }

    /// Mipmap levels of lights' views.
    pub(crate) fn light_levels(&self) -> u32 {
        if self.has_light_levels && self.lights > 0 { self.light_texels.ilog2() } else { 1 }
    }

    /// Size of the textures of lights' views: a square tile for each light in one row. Where there is none, a texel is bound.
    pub(crate) fn light_size(&self) -> [u32; 2] {
        if self.lights == 0 {
            return [1; 2];
        }
        [self.light_texels * self.lights, self.light_texels]
    }

    /// Next cheaper plan, if there is one.
    fn cheaper(self) -> Option<Self> {
        // What is seen least goes first.
        if self.light_texels > 2 * LEAST_LIGHT_TEXELS {
            return Some(Self { light_texels: self.light_texels / 2, ..self });
        }
        if self.divisor < LARGEST_DIVISOR {
            return Some(Self { divisor: self.divisor + 1, ..self });
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
    fn plans_shrink_until_they_fit_or_nothing_is_left() {
        let plan = Plan { size: [1280, 720], light_texels: 512, lights: 1, divisor: 1, has_light_levels: false };
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
