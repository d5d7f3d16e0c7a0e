//! Twin of `blur_kernel.wgsl` and `kernel.wgsl`.

use glam::{IVec2, Vec3, Vec4, Vec4Swizzles};

use crate::uniform::{KernelTerm, ScreenDomain};

/// Depth of the background is beyond everything.
const BACKGROUND_MM: f32 = 50_000.0;

/// Light blurred by a term of a separable kernel along its axis, at every texel of maps; depth in mm in the fourth channel.
///
/// # Panics
/// If `light` has fewer texels than the maps.
#[must_use]
pub fn blur_kernel(term: &KernelTerm, domain: &ScreenDomain, light: &[Vec4]) -> Vec<Vec4> {
    let [width, height] = domain.size.map(u32::cast_signed);
    let blur = Blur { term, domain, light };
    (0..height).flat_map(|y| (0..width).map(move |x| IVec2::new(x, y))).map(|texel| blur.blurred(texel)).collect()
}

struct Blur<'a> {
    term: &'a KernelTerm,
    domain: &'a ScreenDomain,
    light: &'a [Vec4],
}

impl Blur<'_> {
    /// Light at a texel, clamped to the maps.
    fn at(&self, texel: IVec2) -> Vec4 {
        let last = IVec2::from(self.domain.size.map(u32::cast_signed)) - 1;
        let [x, y] = texel.clamp(IVec2::ZERO, last).to_array().map(i32::cast_unsigned);
        self.light[(y * self.domain.size[0] + x) as usize]
    }

    /// Light that a tap receives `step` texels away: what differs in depth counts less, and the light of the centre the more.
    fn received(&self, texel: IVec2, step: f32, centre: Vec4) -> Vec3 {
        let low = step.floor().clamp(-32_768.0, 32_768.0);
        let axis = IVec2::from(self.term.axis);
        #[allow(clippy::cast_possible_truncation, reason = "clamped")]
        let first = texel + low as i32 * axis;
        let there = self.at(first).lerp(self.at(first + axis), (step - low).clamp(0.0, 1.0));
        let d = there.w - centre.w;
        centre.xyz().lerp(there.xyz(), (-(d * d * self.term.falloff).min(80.0)).exp())
    }

    /// Light blurred at a texel.
    fn blurred(&self, texel: IVec2) -> Vec4 {
        let (term, domain, centre) = (self.term, self.domain, self.at(texel));
        let focal_texels = domain.focal_texels[usize::from(term.axis[0] == 0)];
        let texels_per_mm = focal_texels / (domain.middle_mm + domain.perspective * centre.w).max(1e-3);
        let taps = term.taps.map(Vec4::from);
        let mut sum = taps[0].xyz() * centre.xyz();
        let side = if centre.w > BACKGROUND_MM { 1 } else { term.side as usize };
        for tap in &taps[1..side] {
            let step = tap.w * texels_per_mm;
            sum += tap.xyz() * (self.received(texel, step, centre) + self.received(texel, -step, centre));
        }
        sum.clamp(Vec3::splat(-60_000.0), Vec3::splat(60_000.0)).extend(centre.w)
    }
}
