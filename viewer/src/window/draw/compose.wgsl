// A picture, ten times what it differs from another by, or a half of each, over the whole window. Both hold display values.

@group(0) @binding(0) var picture: texture_2d<f32>;
@group(0) @binding(1) var reference: texture_2d<f32>;

// Whether the target encodes what it is given as sRGB.
override encodes: bool = false;

@vertex
fn cover(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32(index & 1u) * 4.0 - 1.0, f32(index >> 1u) * 4.0 - 1.0, 0.0, 1.0);
}

fn given(display: vec3f) -> vec4f {
    let linear = select(pow((display + 0.055) / 1.055, vec3f(2.4)), display / 12.92, display <= vec3f(0.04045));
    return vec4f(select(display, linear, encodes), 1.0);
}

// A window that has just grown is larger than the picture for a frame.
fn texel(image: texture_2d<f32>, position: vec4f) -> vec3f {
    let at = min(vec2u(position.xy), textureDimensions(image) - 1u);
    return textureLoad(image, at, 0).rgb;
}

@fragment
fn plain(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return given(texel(picture, position));
}

@fragment
fn difference(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return given(min(10.0 * abs(texel(picture, position) - texel(reference, position)), vec3f(1.0)));
}

@fragment
fn split(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let middle = floor(0.5 * f32(textureDimensions(picture).x));
    if abs(position.x - middle) < 1.0 {
        return given(vec3f(0.92));
    }
    if position.x < middle {
        return given(texel(picture, position));
    }
    return given(texel(reference, position));
}
