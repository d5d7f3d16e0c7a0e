//! Twin of `blur_kernel.wgsl` and `kernel.wgsl`.

use std::f32::consts::FRAC_PI_2;

use glam::{IVec2, Vec2, Vec3, Vec4, Vec4Swizzles};

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

/// Number of a texel's own, 0 to 1.
fn random(texel: IVec2) -> f32 {
    let [x, y] = texel.to_array().map(i32::cast_unsigned);
    let seed = x.wrapping_mul(1_664_525).wrapping_add(y.wrapping_mul(22_695_477));
    let state = seed.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
    let word = ((state >> ((state >> 28) + 4)) ^ state).wrapping_mul(277_803_737);
    #[allow(clippy::cast_precision_loss, reason = "24 bits")]
    let high = (((word >> 22) ^ word) >> 8) as f32;
    high / 16_777_216.0
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

    /// Light that a tap receives from what is there: what differs in depth counts less, and the light of the centre the more.
    fn received(&self, there: Vec4, centre: Vec4) -> Vec3 {
        let d = there.w - centre.w;
        centre.xyz().lerp(there.xyz(), (-(d * d * self.term.falloff).min(80.0)).exp())
    }

    /// Light of a tap `step` texels away along the axis, between two of them.
    fn along_axis(&self, texel: IVec2, step: f32) -> Vec4 {
        let low = step.floor().clamp(-32_768.0, 32_768.0);
        let axis = IVec2::from(self.term.axis);
        #[allow(clippy::cast_possible_truncation, reason = "clamped")]
        let first = texel + low as i32 * axis;
        self.at(first).lerp(self.at(first + axis), (step - low).clamp(0.0, 1.0))
    }

    /// Light of a tap that is turned off the axis, at the nearest texel.
    fn off_axis(&self, texel: IVec2, step: Vec2) -> Vec4 {
        let most = Vec2::splat(32_768.0);
        self.at(texel + (step + 0.5).floor().clamp(-most, most).as_ivec2())
    }

    /// Light blurred at a texel.
    fn blurred(&self, texel: IVec2) -> Vec4 {
        let (term, domain, centre) = (self.term, self.domain, self.at(texel));
        let focal_texels = Vec2::from(domain.focal_texels);
        let texels_per_mm = focal_texels / (domain.middle_mm + domain.perspective * centre.w).max(1e-3);
        let axis = IVec2::from(term.axis).as_vec2();
        let turned = Vec2::from_angle((random(texel) - 0.5) * FRAC_PI_2).rotate(axis);
        let taps = term.taps.map(Vec4::from);
        let mut sum = taps[0].xyz() * centre.xyz();
        let side = if centre.w > BACKGROUND_MM { 1 } else { term.side as usize };
        for (i, tap) in taps.iter().enumerate().take(side).skip(1) {
            let both = if domain.is_jittered != 0 && i % 3 == 1 {
                let step = tap.w * texels_per_mm * turned;
                [step, -step].map(|step| self.off_axis(texel, step))
            } else {
                let step = tap.w * texels_per_mm.dot(axis);
                [step, -step].map(|step| self.along_axis(texel, step))
            };
            sum += tap.xyz() * (self.received(both[0], centre) + self.received(both[1], centre));
        }
        sum.clamp(Vec3::splat(-60_000.0), Vec3::splat(60_000.0)).extend(centre.w)
    }
}
