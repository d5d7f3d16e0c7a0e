// Light of the environment on BTFs, by importance samples.

// Three random numbers, 0 to 1, of a pixel of the picture, always the same (hash of three integers, Jarzynski and Olano 2020).
fn random_numbers(pixel: vec2<u32>) -> vec3<f32> {
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

// pi times the radiance towards the eye under the environment, from samples of one of the texels around: the mean of
// F(light) L(light) / density. Each sample takes L as blurred as its share of all directions is wide (Krivanek and Colbert
// 2008).
fn ambient_light(in: Varying, lod: f32, eye: ViewCoord, tangents: Tangents) -> vec3<f32> {
    let count = clamp(btf_texture.samples, 1u, 4096u);
    let chance = random_numbers(vec2<u32>(in.clip.xy));
    let brdf = apparent_brdf(random_tap(in.uv, lod, chance.z), eye);
    let source = light_sampler(brdf, eye);
    var sum = vec3<f32>(0.0);
    for (var k = 0u; k < count; k++) {
        // A lattice of rank 1, shifted for each pixel.
        let random = fract(chance.xy + f32(k) * vec2<f32>(1.0 / f32(count), 0.618034));
        let drawn = sample_light(source, random);
        // GGX of roughness r has most of its reflection within some 4 pi r^4 sr.
        let roughness = min(sqrt(sqrt(1.0 / (f32(count) * drawn.w * 4.0 * PI))), 1.0);
        let towards = drawn.x * tangents.x + drawn.y * tangents.y + drawn.z * tangents.z;
        sum += btf_value(brdf, drawn.xyz, eye) * sky_radiance(towards, roughness) / drawn.w;
    }
    return sum / f32(count);
}
