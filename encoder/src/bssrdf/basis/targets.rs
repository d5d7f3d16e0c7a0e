//! What the fit is to reach: the gather of the file at some pixels of a patch, under all lights at once.

use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::Addressing;

use super::rings::{Rings, root_at};
use crate::math::parallel;

/// Exitance at `samples`, numbers of pixels, under each light; shape `[light][c][sample]`.
pub(super) fn gather(
    material: &Bssrdf<'_>,
    rings: &Rings,
    pixels: &[[i32; 2]],
    (size, addressing): ([u32; 2], Addressing),
    lights: &[Vec<f32>],
    samples: &[usize],
) -> Vec<[Vec<f32>; 3]> {
    let knots: Vec<_> = rings.radii_mm.iter().map(|r_mm| material.knot(*r_mm)).collect();
    // Of all lights beside each other: they are summed together.
    let lit: Vec<f32> = (0..pixels.len()).flat_map(|pixel| lights.iter().map(move |light| light[pixel])).collect();
    let width = size[0] as usize;
    let area = material.header().pitch_mm * material.header().pitch_mm;
    let sums = |sample: usize| {
        let place = [sample % width, sample / width].map(|k| i32::try_from(k).expect("a side is below 65,536"));
        let profile = material.profile(pixels[sample]);
        let own: Vec<[f32; 3]> = knots.iter().map(|knot| root_at(&profile, *knot)).collect();
        let mut sums = vec![0.0_f32; 3 * lights.len()];
        for &([dx, dy], ring) in &rings.offsets {
            let [x, y] = [addressing.map(place[0] + dx, size[0]), addressing.map(place[1] + dy, size[1])];
            let from = y as usize * width + x as usize;
            // Tables of all pixels would take gigabytes where windows are wide.
            let other = root_at(&material.profile(pixels[from]), knots[ring]);
            let irradiance = &lit[from * lights.len()..][..lights.len()];
            for (c, sums) in sums.chunks_exact_mut(lights.len()).enumerate() {
                let rd = own[ring][c] * other[c] * area;
                sums.iter_mut().zip(irradiance).for_each(|(sum, e)| *sum += rd * e);
            }
        }
        sums
    };
    let all: Vec<Vec<f32>> = parallel::map(samples.len(), |k| sums(samples[k]));
    let of = |light: usize, c: usize| all.iter().map(|sums| sums[c * lights.len() + light]).collect();
    (0..lights.len()).map(|light| [0, 1, 2].map(|c| of(light, c))).collect()
}
