// Values and samples for lists of texels, lights, views and random numbers, bit for bit as the device has them.

// Unit vector towards the light, and the lower half of the texel's number.
@group(0) @binding(0) var lights: texture_2d<f32>;
// Unit vector towards the eye, and the upper half.
@group(0) @binding(1) var views: texture_2d<f32>;
// Two numbers, 0 to 1.
@group(0) @binding(2) var randoms: texture_2d<f32>;

struct Answer {
    // Bits of linear rgb and of the light's density.
    @location(0) value: vec4<u32>,
    // Bits of a light that was drawn and of its density.
    @location(1) drawn: vec4<u32>,
}

@fragment
fn answer(@builtin(position) at: vec4<f32>) -> Answer {
    let place = vec2<u32>(at.xy);
    let light = textureLoad(lights, place, 0);
    let view = textureLoad(views, place, 0);
    let seen = seen_from(view.xyz);
    let texel = u32(light.w) | (u32(view.w) << 16u);
    let apparent = apparent_of(texel, seen);
    let value = value_of(apparent, light.xyz, seen);
    let source = sampler_of(apparent, seen);
    let pdf = density_of(source, light.xyz);
    let drawn = sampled(source, textureLoad(randoms, place, 0).xy);
    return Answer(bitcast<vec4<u32>>(vec4<f32>(value, pdf)), bitcast<vec4<u32>>(drawn));
}
