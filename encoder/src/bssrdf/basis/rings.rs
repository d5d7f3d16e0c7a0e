//! Distances of pixels in a window, and f_x at them.

use crate::math::parallel;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::{Knot, LocalProfile};

/// Distances that are told apart, at most; of larger windows the nearest of as many is taken.
const MOST: usize = 512;

/// Offsets within the window that light reaches, each with the number of its distance.
pub(super) struct Rings {
    /// Distances in mm, rising.
    pub(super) radii_mm: Vec<f32>,
    /// Offsets and numbers of their distances.
    pub(super) offsets: Vec<([i32; 2], usize)>,
}

impl Rings {
    pub(super) fn of(material: &Bssrdf<'_>) -> Self {
        let header = material.header();
        let radius = i32::from(header.window_radius);
        let steps = (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy]));
        let reached = steps.filter_map(|[dx, dy]| {
            let r_mm = material.distance_mm(dx, dy)?;
            material.knot(r_mm).map(|_| ([dx, dy], r_mm))
        });
        let reached: Vec<([i32; 2], f32)> = reached.collect();
        let mut radii_mm: Vec<f32> = reached.iter().map(|(_, r_mm)| *r_mm).collect();
        radii_mm.sort_by(f32::total_cmp);
        radii_mm.dedup();
        if radii_mm.len() > MOST {
            let last = radii_mm[radii_mm.len() - 1];
            #[allow(clippy::cast_precision_loss, reason = "a few hundred")]
            let even = (0..MOST).map(|k| last * (k as f32 / (MOST - 1) as f32));
            radii_mm = even.collect();
        }
        let nearest = |r_mm: f32| {
            let above = radii_mm.partition_point(|radius| *radius < r_mm).min(radii_mm.len() - 1);
            let below = above.saturating_sub(1);
            if r_mm - radii_mm[below] < radii_mm[above] - r_mm { below } else { above }
        };
        Self { offsets: reached.into_iter().map(|(offset, r_mm)| (offset, nearest(r_mm))).collect(), radii_mm }
    }
}

/// f_x = exp(½ P̂_x) in mm⁻¹ of some pixels at some distances, shape `[pixel][distance][rgb]`.
pub(super) fn profiles(material: &Bssrdf<'_>, pixels: &[[i32; 2]], radii_mm: &[f32]) -> Vec<[f32; 3]> {
    let knots: Vec<_> = radii_mm.iter().map(|r_mm| material.knot(*r_mm)).collect();
    let of_pixel = |pixel: [i32; 2]| -> Vec<[f32; 3]> {
        let profile = material.profile(pixel);
        knots.iter().map(|knot| root_at(&profile, *knot)).collect()
    };
    parallel::map(pixels.len(), |k| of_pixel(pixels[k])).concat()
}

/// f_x = exp(½ P̂_x) in mm⁻¹ of one profile; 0 beyond its end.
pub(super) fn root_at(profile: &LocalProfile<'_>, knot: Option<Knot>) -> [f32; 3] {
    knot.map_or([0.0; 3], |knot| profile.at(knot).map(|p| (0.5 * p).exp()))
}
