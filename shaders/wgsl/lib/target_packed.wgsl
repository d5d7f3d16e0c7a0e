// What passes keep for later ones: the bits of half floats, where nothing can be drawn to half floats themselves.

alias Kept = vec4<u32>;
alias KeptImage = texture_2d<u32>;
alias KeptLayers = texture_2d_array<u32>;

// Rounded to the nearest; what is too large becomes the largest.
fn half_bits(value: f32) -> u32 {
    let sign = (bitcast<u32>(value) >> 16u) & 0x8000u;
    let magnitude = min(abs(value), 65504.0);
    // 2^-14: below it numbers are multiples of 2^-24.
    if magnitude < 6.103515625e-5 {
        return sign | u32(magnitude * 16777216.0 + 0.5);
    }
    // From a bias of 127 and 23 bits to one of 15 and 10 bits.
    // What is no number becomes the largest, too.
    return sign | min((bitcast<u32>(magnitude) + 0x1000u - 0x38000000u) >> 13u, 0x7bffu);
}

fn half_value(bits: u32) -> f32 {
    let sign = select(1.0, -1.0, (bits & 0x8000u) != 0u);
    let magnitude = bits & 0x7fffu;
    if magnitude < 0x400u {
        return sign * f32(magnitude) / 16777216.0;
    }
    return sign * bitcast<f32>((magnitude << 13u) + 0x38000000u);
}

fn kept(values: vec4<f32>) -> Kept {
    return vec4<u32>(half_bits(values.x), half_bits(values.y), half_bits(values.z), half_bits(values.w));
}

fn told(texel: Kept) -> vec4<f32> {
    return vec4<f32>(half_value(texel.x), half_value(texel.y), half_value(texel.z), half_value(texel.w));
}
