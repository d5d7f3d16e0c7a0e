// Values for the display: encoded by the shader, or left linear where the format of the target encodes.

// Whether the shader encodes by IEC 61966-2-1.
override ENCODE_SRGB: bool = true;

// What the target takes for linear light, linear Rec. 709 in 0 to 1.
fn display_value(light: vec3<f32>) -> vec3<f32> {
    if ENCODE_SRGB {
        return srgb(light);
    }
    return light;
}
