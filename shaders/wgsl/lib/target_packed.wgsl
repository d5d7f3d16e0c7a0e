// Texels of intermediate targets: the bits of four half floats as integers, where half floats cannot be drawn to.

alias TargetTexel = vec4<u32>;
alias TargetTexture = texture_2d<u32>;
alias TargetTextureArray = texture_2d_array<u32>;

// Bits of a half float: rounded to the nearest, at most the largest finite one.
fn half_bits(value: f32) -> u32 {
    let sign = (bitcast<u32>(value) >> 16u) & 0x8000u;
    let magnitude = min(abs(value), 65504.0);
    // 2^-14: below it numbers are multiples of 2^-24.
    if magnitude < 6.103515625e-5 {
        return sign | u32(magnitude * 16777216.0 + 0.5);
    }
    // From a bias of 127 and 23 bits to one of 15 and 10 bits.
    // NaN becomes the largest, too.
    return sign | min((bitcast<u32>(magnitude) + 0x1000u - 0x38000000u) >> 13u, 0x7bffu);
}

// Value of the bits of a finite half float.
fn half_value(bits: u32) -> f32 {
    let sign = select(1.0, -1.0, (bits & 0x8000u) != 0u);
    let magnitude = bits & 0x7fffu;
    if magnitude < 0x400u {
        return sign * f32(magnitude) / 16777216.0;
    }
    return sign * bitcast<f32>((magnitude << 13u) + 0x38000000u);
}

// What is drawn for four values.
fn pack(values: vec4<f32>) -> TargetTexel {
    return vec4<u32>(half_bits(values.x), half_bits(values.y), half_bits(values.z), half_bits(values.w));
}

// Four values of a texel.
fn unpack(texel: TargetTexel) -> vec4<f32> {
    return vec4<f32>(half_value(texel.x), half_value(texel.y), half_value(texel.z), half_value(texel.w));
}
