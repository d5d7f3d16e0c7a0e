//! Logarithmic scales of codebooks: gains as codes of a few bits.

use subsurf_decoder::btf::nested::layout::{MAX_OCTAVES, STEPS_PER_OCTAVE, Scales};

/// Fineness with which gains are stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Fineness {
    /// Bits of a code, the sign not counted.
    pub(crate) bits: u8,
    /// Binary logarithm of the step, in 1/64 octaves.
    pub(crate) step: u8,
}

const STEPS: f32 = STEPS_PER_OCTAVE as f32;

/// Scales of a codebook whose largest code stands for the largest gain.
#[allow(clippy::cast_possible_truncation, reason = "octaves of finite gains")]
pub(crate) fn scales(gains: impl Iterator<Item = f32>, fineness: Fineness, is_signed: bool) -> Scales {
    let largest = gains.map(f32::abs).fold(0.0, f32::max).max(f32::MIN_POSITIVE);
    let top = (STEPS * largest.log2()).ceil() as i32;
    let reach = ((1 << fineness.bits) - 1) << fineness.step;
    let limit = MAX_OCTAVES * STEPS_PER_OCTAVE;
    let signed_reach = if is_signed { 2 * reach + (1 << fineness.step) } else { reach };
    let offset = (top - reach).clamp(-limit, limit - signed_reach);
    let offset = i16::try_from(offset).expect("within ±28 octaves");
    Scales { bits: fineness.bits + u8::from(is_signed), step: fineness.step, offset }
}

/// Code of the nearest gain.
#[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
pub(crate) fn code(scales: Scales, gain: f32, is_signed: bool) -> u32 {
    let bits = u32::from(scales.bits) - u32::from(is_signed);
    let steps =
        (STEPS * gain.abs().max(f32::MIN_POSITIVE).log2() - f32::from(scales.offset)) / (1_i32 << scales.step) as f32;
    let magnitude = steps.round().clamp(0.0, ((1_u32 << bits) - 1) as f32) as u32;
    magnitude | if is_signed && gain < 0.0 { 1 << bits } else { 0 }
}

/// Gain that a code stands for.
pub(crate) fn gain(scales: Scales, code: u32, is_signed: bool) -> f32 {
    let bits = u32::from(scales.bits) - u32::from(is_signed);
    let steps = (code & ((1 << bits) - 1)) << scales.step;
    let size = ((steps as f32 + f32::from(scales.offset)) / STEPS).exp2();
    if is_signed && code >> bits == 1 { -size } else { size }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gains_come_back_within_half_a_step() {
        for is_signed in [false, true] {
            let fineness = Fineness { bits: 6, step: 3 };
            let gains = [3.7_f32, 0.5, 0.02, -1.0];
            let scales = scales(gains.iter().copied(), fineness, is_signed);
            for gain in gains.iter().copied().filter(|gain| is_signed || *gain > 0.0) {
                let back = super::gain(scales, code(scales, gain, is_signed), is_signed);
                // Half of 1/8 octave.
                assert!((back / gain).log2().abs() <= 0.5 / 8.0 + 1e-4, "{gain} {back}");
            }
        }
    }
}
