// Triangles of the panel over the picture. Colours are display values with premultiplied alpha, as egui mixes them.

struct Screen {
    // Width and height in points; y down.
    size: vec2f,
    unused: vec2f,
}

@group(0) @binding(0) var<uniform> screen: Screen;
@group(1) @binding(0) var image: texture_2d<f32>;
@group(1) @binding(1) var image_sampler: sampler;

// Whether the target encodes what it is given as sRGB.
override encodes: bool = false;

struct Corner {
    @builtin(position) clip: vec4f,
    @location(0) uv: vec2f,
    @location(1) colour: vec4f,
}

@vertex
fn corner(@location(0) at: vec2f, @location(1) uv: vec2f, @location(2) colour: vec4f) -> Corner {
    let clip = vec2f(2.0 * at.x / screen.size.x - 1.0, 1.0 - 2.0 * at.y / screen.size.y);
    return Corner(vec4f(clip, 0.0, 1.0), uv, colour);
}

fn decoded(value: vec3f) -> vec3f {
    return select(pow((value + 0.055) / 1.055, vec3f(2.4)), value / 12.92, value <= vec3f(0.04045));
}

@fragment
fn mixed(in: Corner) -> @location(0) vec4f {
    let colour = in.colour * textureSampleLevel(image, image_sampler, in.uv, 0.0);
    if encodes {
        return vec4f(decoded(colour.rgb), colour.a);
    }
    return colour;
}
