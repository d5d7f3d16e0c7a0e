//! How the samples that lights see are cut into levels and rings.

use subsurf_decoder::bssrdf::BssrdfHeader;
use subsurf_shaders::uniform::MAX_RINGS;

use crate::technique::area::divisor_of;

/// Edge of samples of the first ring, in pixels of the material.
const SAMPLE_PIXELS: f32 = 1.0;
/// Where a ring begins to fade out, in edges of its samples.
const RING: f32 = 2.0;
/// Where it ends, by where it begins to fade out.
const FADE: f32 = 1.6;
/// Where the last ring fades out: beyond everything.
const BEYOND: [f32; 2] = [1e6, 2e6];
/// Texels of the finest target to an edge of a sample of the first ring.
const TEXELS_PER_SAMPLE: f32 = 2.0;

/// Levels and rings of the samples of splats, for a mesh of a certain size.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SplatLevels {
    /// Level of shadow maps that the first ring takes its samples from; each further ring takes the next.
    pub first: u32,
    /// Number of rings.
    pub rings: u32,
}

impl SplatLevels {
    /// Levels for views of `light_texels` to a side, of what lies within `radius_mm`.
    #[must_use]
    pub fn new(header: &BssrdfHeader, radius_mm: f32, light_texels: u32) -> Self {
        #[allow(clippy::cast_precision_loss, reason = "a thousand")]
        let texel_mm = 2.0 * radius_mm / light_texels as f32;
        let sample_mm = SAMPLE_PIXELS * header.pitch_mm;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let first = (sample_mm / texel_mm).log2().round().clamp(1.0, 5.0) as u32;
        #[allow(clippy::cast_precision_loss, reason = "small")]
        let first_mm = texel_mm * (1_u32 << first) as f32;
        let reach = header.r_max_mm / (RING * first_mm);
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
        let rings = (reach.log2().ceil() + 1.0).clamp(1.0, MAX_RINGS as f32) as u32;
        Self { first, rings: rings.min(light_texels.ilog2().saturating_sub(first).max(1)) }
    }

    /// Number of levels of shadow maps.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.first + self.rings
    }

    /// Distances at which a ring begins and ends to fade in, both 0 for the first, and to fade out; in edges of samples of the first
    /// ring.
    #[must_use]
    pub fn fades(&self, ring: u32) -> [[f32; 2]; 2] {
        // It ends where the next begins.
        let fade = |ring: u32| {
            #[allow(clippy::cast_precision_loss, reason = "small")]
            let end = RING * (1_u32 << ring) as f32;
            [end, FADE * end]
        };
        let fade_in = ring.checked_sub(1).map_or([0.0; 2], fade);
        [fade_in, if ring + 1 == self.rings { BEYOND } else { fade(ring) }]
    }

    /// Width and height of a ring's target, when the finest has `size`.
    #[must_use]
    pub fn ring_size(size: [u32; 2], ring: u32) -> [u32; 2] {
        size.map(|side| side.div_ceil(1 << ring).max(1))
    }
}

/// Pixels of the picture to a side of a texel of the finest target, when a mm of the material covers `pixels_per_mm`.
pub(crate) fn divisor(header: &BssrdfHeader, radius_mm: f32, light_texels: u32, pixels_per_mm: f32) -> f32 {
    let levels = SplatLevels::new(header, radius_mm, light_texels);
    #[allow(clippy::cast_precision_loss, reason = "small")]
    let sample_mm = 2.0 * radius_mm / light_texels as f32 * (1_u32 << levels.first) as f32;
    divisor_of(sample_mm * pixels_per_mm / TEXELS_PER_SAMPLE, 8.0)
}
