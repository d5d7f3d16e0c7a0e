//! Twin of `sum_kernel.wgsl`.

use glam::{Vec3, Vec4, Vec4Swizzles};

use super::blur_kernel;
use crate::uniform::{KernelTerm, ScreenDomain};

/// Sum over the terms so far of a separable kernel, with one that is blurred along columns here; depth in mm in the fourth channel.
///
/// # Panics
/// If `light` has fewer texels than the maps.
#[must_use]
pub fn sum_kernel(term: &KernelTerm, domain: &ScreenDomain, light: &[Vec4], sums: &[Vec4]) -> Vec<Vec4> {
    let sign = Vec4::from(term.sign).xyz();
    let (least, most) = (Vec3::splat(-60_000.0), Vec3::splat(60_000.0));
    let blurred = blur_kernel(term, domain, light);
    let summed = blurred
        .iter()
        .zip(sums)
        .map(|(light, sum)| (sum.xyz() + sign * light.xyz()).clamp(least, most).extend(light.w));
    summed.collect()
}
