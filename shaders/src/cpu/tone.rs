//! Twin of `tone.wgsl`.

use glam::Vec3;

use crate::rgb::Rgb;

/// Khronos PBR Neutral tone mapper (2024): base colours below 0.8 stay as they are, highlights lose saturation smoothly.
#[must_use]
pub fn neutral(light: Rgb) -> Rgb {
    const START: f32 = 0.8 - 0.04;
    let light = Vec3::from(light);
    let least = light.min_element();
    let offset = if least < 0.08 { least - 6.25 * least * least } else { 0.04 };
    let colour = light - offset;
    let peak = colour.max_element();
    if peak < START {
        return colour.into();
    }
    let span = 1.0 - START;
    let new_peak = 1.0 - span * span / (peak + span - START);
    let grey = 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0);
    (colour * new_peak / peak).lerp(Vec3::splat(new_peak), grey).into()
}

/// IEC 61966-2-1, clamped to 0 .. 1.
#[must_use]
pub fn srgb(linear: Rgb) -> Rgb {
    linear.map(|c| {
        let c = c.clamp(0.0, 1.0);
        if c <= 0.003_130_8 { 12.92 * c } else { 1.055 * c.powf(1.0 / 2.4) - 0.055 }
    })
}

/// Inverse of [`srgb`].
#[must_use]
pub fn linear(encoded: Rgb) -> Rgb {
    encoded.map(|c| if c <= 0.040_45 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) })
}

/// The byte that a display gets for a tone-mapped, encoded value.
#[must_use]
pub fn display(encoded: Rgb) -> [u8; 3] {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to 255 after the clamp")]
    encoded.map(|c| (c.clamp(0.0, 1.0) * 255.0).round() as u8)
}
