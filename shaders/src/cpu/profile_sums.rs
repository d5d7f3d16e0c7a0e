//! Twin of `profile_sums.wgsl`.

use subsurf_decoder::Bssrdf;

use crate::rgb::Rgb;
use crate::separable::ProfileSums;

/// Weighted sums over the profiles of all pixels of a patch, row by row; shape `[l][height][width]`.
#[must_use]
pub fn profile_sums(material: &Bssrdf<'_>, sums: &ProfileSums) -> Vec<Vec<Rgb>> {
    let header = material.header();
    let pixels = (0..header.height).flat_map(|y| (0..header.width).map(move |x| [x, y].map(u32::cast_signed)));
    let mut all = vec![Vec::new(); sums.count()];
    for pixel in pixels {
        let profile = material.profile(pixel);
        let mut of_pixel = vec![[0.0_f32; 3]; sums.count()];
        for (k, (knot, s)) in sums.knots.iter().enumerate() {
            let value = profile.at(*knot).map(|p| (s * p).exp());
            for (sum, factors) in of_pixel.iter_mut().zip(&sums.factors) {
                *sum = [0, 1, 2].map(|c| sum[c] + factors[k][c] * value[c]);
            }
        }
        all.iter_mut().zip(of_pixel).for_each(|(all, sum)| all.push(sum));
    }
    all
}
