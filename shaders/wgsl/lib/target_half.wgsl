// Texels of intermediate targets: four half floats.

alias TargetTexel = vec4<f32>;
alias TargetTexture = texture_2d<f32>;
alias TargetTextureArray = texture_2d_array<f32>;

// What is drawn for four values: rounded to the 11 bits of half floats, ties to even. Some drivers cut the other bits off, and
// every pass would be a little darker than the one before.
fn pack(values: vec4<f32>) -> TargetTexel {
    let bits = bitcast<vec4<u32>>(values);
    return bitcast<vec4<f32>>((bits + vec4<u32>(0xFFFu) + ((bits >> vec4<u32>(13u)) & vec4<u32>(1u))) & vec4<u32>(0xFFFFE000u));
}

// Four values of a texel.
fn unpack(texel: TargetTexel) -> vec4<f32> {
    return texel;
}
