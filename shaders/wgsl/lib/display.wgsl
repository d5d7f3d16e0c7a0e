// Values for the target: tone-mapped or not, encoded by the shader, or left linear where the format of the target encodes.

// Whether light is tone-mapped to 0 to 1.
override TONE_MAP: bool = true;
// Whether the shader encodes by IEC 61966-2-1.
override ENCODE_SRGB: bool = true;

// What the target takes for linear light, linear Rec. 709.
fn display_value(light: vec3<f32>) -> vec3<f32> {
    var value = light;
    if TONE_MAP {
        value = neutral(light);
    }
    if ENCODE_SRGB {
        return srgb(value);
    }
    return value;
}
