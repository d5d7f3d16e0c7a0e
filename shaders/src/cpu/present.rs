//! Twin of `present.wgsl`.

use super::{display, neutral, srgb};
use crate::rgb::Rgb;

/// The picture of a flat patch: exitance times `exposure`, tone-mapped, `size` pixels for `texels` texels.
///
/// # Panics
/// If `exitance` has fewer than `texels` entries.
#[must_use]
pub fn present(exitance: &[Rgb], texels: [u32; 2], size: [u32; 2], exposure: f32) -> Vec<[u8; 3]> {
    let texel = |at: u32, axis: usize| (at * texels[axis] / size[axis]).min(texels[axis] - 1) as usize;
    let pixels = (0..size[1]).flat_map(|y| (0..size[0]).map(move |x| (x, y)));
    pixels
        .map(|(x, y)| {
            let light = exitance[texel(y, 1) * texels[0] as usize + texel(x, 0)];
            display(srgb(neutral(light.map(|light| light * exposure))))
        })
        .collect()
}
