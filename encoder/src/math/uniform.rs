//! The uniform quantiser.

/// Offset and step: value = offset + step · code.
pub(crate) type OffsetStep = [f32; 2];

/// Offset, step and codes from 0 to `most` of values, even between the least and the largest.
pub(crate) fn codes(values: impl Iterator<Item = f32> + Clone, most: u16) -> (OffsetStep, Vec<u16>) {
    let [low, high] =
        values.clone().fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], value| [low.min(value), high.max(value)]);
    if low >= high || low.is_infinite() {
        let offset = if low.is_finite() { low } else { 0.0 };
        return ([offset, 0.0], values.map(|_| 0).collect());
    }
    let step = (high - low) / f32::from(most);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within 0 to the largest code")]
    let code = |value: f32| ((value - low) / step).round().clamp(0.0, f32::from(most)) as u16;
    ([low, step], values.map(code).collect())
}
