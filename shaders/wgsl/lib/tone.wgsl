// Tone mapping, and the sRGB transfer function both ways.

// Tone mapper PBR Neutral (Khronos 2024), linear in and out: base colours below 0.8 stay as they are, highlights lose
// saturation smoothly.
fn neutral(light: vec3<f32>) -> vec3<f32> {
    let start = 0.8 - 0.04;
    let least = min(light.x, min(light.y, light.z));
    let offset = select(0.04, least - 6.25 * least * least, least < 0.08);
    let colour = light - offset;
    let peak = max(colour.x, max(colour.y, colour.z));
    if peak < start {
        return colour;
    }
    let span = 1.0 - start;
    let new_peak = 1.0 - span * span / (peak + span - start);
    let grey = 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0);
    return mix(colour * new_peak / peak, vec3<f32>(new_peak), grey);
}

// sRGB value of linear light, both 0 to 1 (IEC 61966-2-1).
fn srgb(linear: vec3<f32>) -> vec3<f32> {
    let c = clamp(linear, vec3<f32>(0.0), vec3<f32>(1.0));
    return select(1.055 * pow(c, vec3<f32>(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3<f32>(0.0031308));
}

// Linear light of an sRGB value, its inverse.
fn linear_from_srgb(value: vec3<f32>) -> vec3<f32> {
    return select(pow((value + 0.055) / 1.055, vec3<f32>(2.4)), value / 12.92, value <= vec3<f32>(0.04045));
}
