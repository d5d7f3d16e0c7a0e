// Light from all around.

// Three numbers from 0 to 1 for a pixel, always the same (hash of three integers by Jarzynski and Olano 2020).
fn chances(pixel: vec2<u32>) -> vec3<f32> {
    var v = vec3<u32>(pixel, 0u) * 1664525u + 1013904223u;
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v = v ^ (v >> vec3<u32>(16u));
    v.x += v.y * v.z;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    return vec3<f32>(v >> vec3<u32>(8u)) / 16777216.0;
}

// pi times the radiance under light from all around, by importance samples of one of the texels around: the mean of
// F(light) L(light) / density. Each sample sees L as blurred as its share of all directions is wide (Krivanek and
// Colbert 2008).
fn from_all_around(in: Varying, detail: f32, seen: Seen, tangents: Tangents) -> vec3<f32> {
    let count = clamp(btf_texture.samples, 1u, 4096u);
    let chance = chances(vec2<u32>(in.clip.xy));
    let apparent = apparent_of(tap_drawn(in.uv, detail, chance.z), seen);
    let source = sampler_of(apparent, seen);
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < count; k++) {
        // A lattice of rank 1, shifted for each pixel.
        let random = fract(chance.xy + f32(k) * vec2<f32>(1.0 / f32(count), 0.618034));
        let drawn = sampled(source, random);
        // GGX of roughness r has most of its reflection within some 4 pi r^4 sr.
        let roughness = min(sqrt(sqrt(1.0 / (f32(count) * drawn.w * 4.0 * PI))), 1.0);
        let towards = drawn.x * tangents.x + drawn.y * tangents.y + drawn.z * tangents.z;
        sum += value_of(apparent, drawn.xyz, seen) * sky_radiance(towards, roughness) / drawn.w;
    }
    return sum / f32(count);
}
