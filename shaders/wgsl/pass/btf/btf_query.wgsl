// Needs: <BTF layout>, tone, fullscreen.
// Values and light samples of a BTF for lists of texels, lights, views and random numbers, bit for bit as the device has them.

// Unit vector towards the light, and the lower half of the texel's number.
@group(0) @binding(0) var lights: texture_2d<f32>;
// Unit vector towards the eye, and the upper half.
@group(0) @binding(1) var views: texture_2d<f32>;
// Two random numbers, 0 to 1.
@group(0) @binding(2) var randoms: texture_2d<f32>;

struct BtfAnswer {
    // Bits of the value in linear Rec. 709, and of the probability density of the light per steradian.
    @location(0) value: vec4<u32>,
    // Bits of the sampled light, a unit vector, and of its density.
    @location(1) drawn: vec4<u32>,
}

@fragment
fn btf_query(@builtin(position) at: vec4<f32>) -> BtfAnswer {
    let place = vec2<u32>(at.xy);
    let light = textureLoad(lights, place, 0);
    let view = textureLoad(views, place, 0);
    let eye = view_coord(view.xyz);
    let texel = u32(light.w) | (u32(view.w) << 16u);
    let brdf = apparent_brdf(texel, eye);
    let value = btf_value(brdf, light.xyz, eye);
    let source = light_sampler(brdf, eye);
    let pdf = light_density(source, light.xyz);
    let drawn = sample_light(source, textureLoad(randoms, place, 0).xy);
    return BtfAnswer(bitcast<vec4<u32>>(vec4<f32>(value, pdf)), bitcast<vec4<u32>>(drawn));
}
