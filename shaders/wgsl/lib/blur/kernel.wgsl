// Blur of light on the screen by a term of a separable kernel, along one axis (Jimenez et al. 2015; supplement, section E).

struct KernelTerm {
    // w_i of the taps of one side, from the centre on, linear Rec. 709; o_i in mm in the fourth place.
    taps: array<vec4<f32>, 33>,
    // s, -1 or 1; linear Rec. 709.
    sign: vec4<f32>,
    // (1, 0) or (0, 1).
    axis: vec2<i32>,
    // Taps of one side with the centre, 3 to 33.
    side: u32,
    // 1 / (2 tau_max) in mm^-2.
    falloff: f32,
}

@group(0) @binding(0) var<uniform> term: KernelTerm;
// Light that is blurred; depth in mm in the fourth channel.
@group(0) @binding(2) var light: TargetTexture;

// A product of two even kernels looks the same after a quarter of a turn.
const HALF_PI: f32 = 1.5707963;

// Light at a texel, clamped to the maps.
fn light_at(texel: vec2<i32>) -> vec4<f32> {
    return unpack(textureLoad(light, clamp(texel, vec2<i32>(0), vec2<i32>(domain.size) - 1), 0));
}

// Number of a texel's own, 0 to 1 (Jarzynski and Olano 2020, the hash PCG).
fn random(texel: vec2<i32>) -> f32 {
    let state = (u32(texel.x) * 1664525u + u32(texel.y) * 22695477u) * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) / 16777216.0;
}

// Light that a tap receives from what is there. Where depth differs by d, exp(-d^2 / 2 tau_max) of it is that light; the rest is the
// light of the centre, so that the weights of all taps keep their sum, whatever their signs.
fn received(there: vec4<f32>, centre: vec4<f32>) -> vec3<f32> {
    let d = there.w - centre.w;
    return mix(centre.xyz, there.xyz, exp(-min(d * d * term.falloff, 80.0)));
}

// Light of a tap `step` texels away along the axis, between two of them.
fn along_axis(texel: vec2<i32>, step: f32) -> vec4<f32> {
    let low = clamp(floor(step), -32768.0, 32768.0);
    let first = texel + i32(low) * term.axis;
    return mix(light_at(first), light_at(first + term.axis), clamp(step - low, 0.0, 1.0));
}

// Light of a tap that is turned off the axis, at the nearest texel.
fn off_axis(texel: vec2<i32>, step: vec2<f32>) -> vec4<f32> {
    return light_at(texel + vec2<i32>(clamp(floor(step + 0.5), vec2<f32>(-32768.0), vec2<f32>(32768.0))));
}

// Light blurred at a texel; depth in mm in the fourth channel.
fn blurred(texel: vec2<i32>) -> vec4<f32> {
    let centre = light_at(texel);
    let texels_per_mm = domain.focal_texels / max(domain.middle_mm + domain.perspective * centre.w, 1e-3);
    let axis = vec2<f32>(term.axis);
    let angle = (random(texel) - 0.5) * HALF_PI;
    let turned = cos(angle) * axis + sin(angle) * vec2<f32>(-axis.y, axis.x);
    var sum = term.taps[0].xyz * centre.xyz;
    // Nothing is seen on the background. The end of the loop depends on the texel: where nothing but uniforms says when a loop ends,
    // Mesa's software Vulkan compiles it anew at every draw.
    let side = select(min(term.side, 33u), 1u, centre.w > BACKGROUND_MM);
    for (var i = 1u; i < side; i++) {
        let tap = term.taps[min(i, 32u)];
        if domain.is_jittered != 0u && i % 3u == 1u {
            let step = tap.w * texels_per_mm * turned;
            sum += tap.xyz * (received(off_axis(texel, step), centre) + received(off_axis(texel, -step), centre));
        } else {
            let step = tap.w * dot(texels_per_mm, axis);
            sum += tap.xyz * (received(along_axis(texel, step), centre) + received(along_axis(texel, -step), centre));
        }
    }
    return vec4<f32>(clamp(sum, vec3<f32>(-60000.0), vec3<f32>(60000.0)), centre.w);
}
