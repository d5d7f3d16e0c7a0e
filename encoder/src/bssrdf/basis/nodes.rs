//! The nodes of profiles that coefficients are made of.

use subsurf_decoder::Bssrdf;

use super::lights::spread;

/// Nodes that are taken at most: every one takes an exponential of every pixel when the file is loaded.
const MOST: usize = 16;
/// Share of the brightest node's mean from which a node says something.
const LEAST: f64 = 1e-8;
/// Pixels that scales are taken of, at most.
const PIXELS: usize = 4_096;

/// Nodes of the fit, and what f_x is divided by there.
pub(super) struct Nodes {
    /// S.
    pub(super) samples: u16,
    /// Numbers h of the nodes, rising.
    pub(super) at: Vec<usize>,
    /// Mean of f_x over the patch, shape `[node][rgb]`: the system is well-conditioned when nodes are divided by it.
    scale: Vec<[f64; 3]>,
}

impl Nodes {
    pub(super) fn of(material: &Bssrdf<'_>) -> Self {
        let header = material.header();
        let samples = usize::from(header.samples);
        let count = samples.min(MOST);
        let at: Vec<usize> = (0..count).map(|k| k * (samples - 1) / (count - 1)).collect();
        let [width, height] = [header.width as usize, header.height as usize];
        let mut scale = vec![[0.0; 3]; count];
        let pixels = spread([width, height], PIXELS);
        #[allow(clippy::cast_precision_loss, reason = "a few thousand")]
        let share = 1.0 / pixels.len() as f64;
        for pixel in pixels {
            let profile = material.profile([pixel % width, pixel / width].map(|k| i32::try_from(k).unwrap_or(0)));
            for (scale, h) in scale.iter_mut().zip(&at) {
                let p = profile.node(*h);
                for c in 0..3 {
                    scale[c] += share * (0.5 * f64::from(p[c])).exp();
                }
            }
        }
        Self { samples: header.samples, at, scale }
    }

    /// Number of nodes.
    pub(super) fn count(&self) -> usize {
        self.at.len()
    }

    /// 1 / mean of f_x at a node, in mm; 0 where there is next to nothing.
    pub(super) fn inverse_scale(&self, node: usize, c: usize) -> f64 {
        let brightest = self.scale.iter().map(|scale| scale[c]).fold(0.0, f64::max);
        let scale = self.scale[node][c];
        if scale > LEAST * brightest { 1.0 / scale } else { 0.0 }
    }
}
