//! Albedo of every pixel under uniform light.

use subsurf_decoder::Bssrdf;

use super::basis::ProjectedBasis;
use crate::rgb::Rgb;

/// Albedo of every pixel under uniform light, `[height][width]`, linear Rec. 709.
///
/// By the basis of the file; where it has none, Σ exp(P̂_x(r)) pitch² over the window: approximate, as if all around a pixel
/// were like it.
#[must_use]
pub fn albedo(material: &Bssrdf<'_>) -> Vec<Rgb> {
    ProjectedBasis::of(material).map_or_else(|| own_albedo(material), |basis| basis.albedo())
}

/// Parts of an interval between nodes, each with one value for all offsets in it.
const PARTS: f32 = 4.0;

fn own_albedo(material: &Bssrdf<'_>) -> Vec<Rgb> {
    let header = material.header();
    let area = header.pitch_mm * header.pitch_mm;
    // Number of offsets in every part of every interval, and their mean place.
    let intervals = usize::from(header.samples) - 1;
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
    let mut parts = vec![(0.0_f32, 0.0_f32); intervals * PARTS as usize];
    let radius = i32::from(header.window_radius);
    for [dx, dy] in (-radius..=radius).flat_map(|dy| (-radius..=radius).map(move |dx| [dx, dy])) {
        if let Some(knot) = material.distance_mm(dx, dy).and_then(|r_mm| material.knot(r_mm)) {
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "w is 0 to 1")]
            let part = ((PARTS * knot.w) as usize).min(PARTS as usize - 1);
            #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
            let (count, sum) = &mut parts[knot.h * PARTS as usize + part];
            *count += 1.0;
            *sum += knot.w;
        }
    }
    let pixels = (0..header.height).flat_map(|y| (0..header.width).map(move |x| [x, y].map(u32::cast_signed)));
    let albedo = |pixel: [i32; 2]| {
        let profile = material.profile(pixel);
        let mut sum = [0.0; 3];
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small number")]
        for (h, parts) in parts.chunks(PARTS as usize).enumerate() {
            let ends = [profile.node(h), profile.node(h + 1)];
            for (count, places) in parts.iter().filter(|(count, _)| *count > 0.0) {
                let w = places / count;
                for c in 0..3 {
                    sum[c] += count * ((1.0 - w) * ends[0][c] + w * ends[1][c]).exp();
                }
            }
        }
        sum.map(|sum| sum * area)
    };
    pixels.map(albedo).collect()
}
