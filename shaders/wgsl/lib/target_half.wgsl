// What passes keep for later ones: half floats.

alias Kept = vec4<f32>;
alias KeptImage = texture_2d<f32>;
alias KeptLayers = texture_2d_array<f32>;

fn kept(values: vec4<f32>) -> Kept {
    return values;
}

fn told(texel: Kept) -> vec4<f32> {
    return texel;
}
