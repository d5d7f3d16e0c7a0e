//! Patches that the fit looks at: all of a small material, tiles of a large one, each as if it were alone.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;

use super::lights::{self, judges, spread};
use super::nodes::Nodes;
use super::params::Params;
use super::rings::{Rings, profiles};
use super::targets::gather;

/// Pixels of a material that is looked at as a whole, at most.
const WHOLE: usize = 16_384;
/// Least side of a tile in pixels.
const TILE: usize = 64;
/// Pixels of all tiles, at most where one has fewer: of wider windows one tile is looked at.
const TILES: usize = 262_144;
/// Pixels of a patch that the fit starts from, at most.
const STARTED: usize = 16_384;
/// Pixels of all patches whose exitance is compared, at most.
const SAMPLES: usize = 2_048;
/// Pairs of pixels that are gathered for them, about.
const PAIRS: usize = 4_000_000;
/// Pixels that are compared at least.
const LEAST_SAMPLES: usize = 16;

/// Patch of pixels.
pub(super) struct Patch {
    pub(super) size: [u32; 2],
    pub(super) addressing: Addressing,
    /// f_x at the nodes, each divided by its scale; shape `[c][node][pixel]`.
    pub(super) f: [Vec<Vec<f32>>; 3],
    /// Numbers of the pixels that the fit starts from.
    pub(super) started: Vec<usize>,
    /// f_x of these at 64 distances up to r_max, shape `[pixel][distance][rgb]`, mm⁻¹.
    pub(super) profiles: Vec<[f32; 3]>,
    /// Numbers of the pixels whose exitance is compared.
    pub(super) samples: Vec<usize>,
    /// Lights of the fit.
    pub(super) lit: Vec<Lit>,
    /// Uniform, disc and line light, by which the error is judged.
    pub(super) judged: Vec<Lit>,
}

/// Light on a patch, and what it should make of it.
pub(super) struct Lit {
    /// Irradiance of every pixel.
    pub(super) irradiance: Vec<f32>,
    /// Exitance of every sample, shape `[c][sample]`.
    pub(super) target: [Vec<f32>; 3],
    /// 1 / largest exitance; 0 where all is dark.
    pub(super) inverse_peak: f64,
}

/// Number of distances of [`Patch::profiles`].
pub(super) const RADII: usize = 64;

/// Distances of [`Patch::profiles`] in mm.
pub(super) fn radii_mm(material: &Bssrdf<'_>) -> Vec<f32> {
    let r_max_mm = material.header().r_max_mm;
    #[allow(clippy::cast_precision_loss, reason = "64 distances")]
    let radius = |k: usize| (r_max_mm * (k as f32 / (RADII - 1) as f32)).min(r_max_mm);
    (0..RADII).map(radius).collect()
}

/// Patches of a material.
pub(super) fn patches(material: &Bssrdf<'_>, nodes: &Nodes) -> Vec<Patch> {
    let header = material.header();
    let rings = Rings::of(material);
    let size = [header.width as usize, header.height as usize];
    let (tile, origins, addressing) = if size[0] * size[1] <= WHOLE {
        (size, vec![[0; 2]], header.addressing)
    } else {
        let tile = size.map(|side| side.min(TILE.max(2 * usize::from(header.window_radius) + 1)));
        let has_room = 4 * tile[0] * tile[1] <= TILES;
        // Two to an axis, in the middle of its halves.
        let starts = |axis: usize| -> Vec<usize> {
            let rest = size[axis] - tile[axis];
            if has_room && rest >= tile[axis] { vec![rest / 4, rest - rest / 4] } else { vec![rest / 2] }
        };
        let origins = starts(1).into_iter().flat_map(|y| starts(0).into_iter().map(move |x| [x, y])).collect();
        (tile, origins, Addressing::Clamp)
    };
    let count = origins.len();
    let samples = (PAIRS / rings.offsets.len().max(1)).clamp(LEAST_SAMPLES, SAMPLES) / count;
    let of = |(number, origin): (usize, [usize; 2])| {
        let pixels = (0..tile[1]).flat_map(|y| (0..tile[0]).map(move |x| [origin[0] + x, origin[1] + y]));
        let pixels: Vec<[i32; 2]> = pixels.map(|pixel| pixel.map(|k| i32::try_from(k).unwrap_or(0))).collect();
        // Uniform light falls on all tiles, each of the others on one.
        let all = lights::lights(tile).into_iter().enumerate();
        let of_fit: Vec<Vec<f32>> =
            all.filter(|(k, _)| *k == 0 || k % count == number).map(|(_, light)| light).collect();
        let fitted = of_fit.len();
        let lights: Vec<Vec<f32>> = of_fit.into_iter().chain(judges(tile)).collect();
        let (samples, started) = (spread(tile, samples.max(1)), spread(tile, STARTED));
        let of_start: Vec<[i32; 2]> = started.iter().map(|number| pixels[*number]).collect();
        let size = tile.map(|side| u32::try_from(side).expect("a side is below 65,536"));
        let targets = gather(material, &rings, &pixels, (size, addressing), &lights, &samples);
        let mut lit: Vec<Lit> =
            lights.into_iter().zip(targets).map(|(light, target)| Lit::new(light, target)).collect();
        let judged = lit.split_off(fitted);
        Patch {
            size,
            addressing,
            f: scaled_nodes(material, nodes, &pixels),
            profiles: profiles(material, &of_start, &radii_mm(material)),
            started,
            samples,
            lit,
            judged,
        }
    };
    origins.into_iter().enumerate().map(of).collect()
}

/// f_x at the nodes, each divided by its scale.
fn scaled_nodes(material: &Bssrdf<'_>, nodes: &Nodes, pixels: &[[i32; 2]]) -> [Vec<Vec<f32>>; 3] {
    [0, 1, 2].map(|c| {
        let plane = |k: usize| {
            let (h, inverse) = (nodes.at[k], nodes.inverse_scale(k, c));
            #[allow(clippy::cast_possible_truncation, reason = "numbers around 1")]
            let f = |pixel: &[i32; 2]| ((0.5 * f64::from(material.profile(*pixel).node(h)[c])).exp() * inverse) as f32;
            pixels.iter().map(f).collect()
        };
        (0..nodes.count()).map(plane).collect()
    })
}

impl Patch {
    /// Number of pixels.
    pub(super) fn pixels(&self) -> usize {
        self.size[0] as usize * self.size[1] as usize
    }

    /// Coefficients c_l of all pixels.
    pub(super) fn coefficients(&self, params: &Params, l: usize, c: usize) -> Vec<f32> {
        let mut sums = vec![0.0_f32; self.pixels()];
        for (f, d) in self.f[c].iter().zip(params.factors(l, c)) {
            #[allow(clippy::cast_possible_truncation, reason = "images are in single precision")]
            let d = *d as f32;
            sums.iter_mut().zip(f).for_each(|(sum, f)| *sum += d * f);
        }
        sums
    }

    /// Largest |c_l|.
    pub(super) fn largest(&self, params: &Params, l: usize, c: usize) -> f64 {
        f64::from(self.coefficients(params, l, c).iter().fold(0.0_f32, |most, c| most.max(c.abs())))
    }
}

impl Lit {
    fn new(irradiance: Vec<f32>, target: [Vec<f32>; 3]) -> Self {
        let peak = f64::from(target.iter().flatten().copied().fold(0.0, f32::max));
        Self { irradiance, target, inverse_peak: if peak > 1e-30 { 1.0 / peak } else { 0.0 } }
    }
}
