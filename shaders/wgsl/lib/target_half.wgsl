// Texels of intermediate targets: four half floats.

alias TargetTexel = vec4<f32>;
alias TargetTexture = texture_2d<f32>;
alias TargetTextureArray = texture_2d_array<f32>;

// What is drawn for four values.
fn pack(values: vec4<f32>) -> TargetTexel {
    return values;
}

// Four values of a texel.
fn unpack(texel: TargetTexel) -> vec4<f32> {
    return texel;
}
