// The picture of a mesh of a BTF: what it reflects of lights and of light from all around, tone-mapped.

// The material's own directions, in the world: along its rows, down its columns, and away from it.
struct Tangents {
    x: vec3<f32>,
    y: vec3<f32>,
    z: vec3<f32>,
}

// The side that is seen, whichever way the triangle winds: `plane` is any normal of it.
fn tangents_of(in: Varying, plane: vec3<f32>, to_eye: vec3<f32>) -> Tangents {
    let normal = normalize(in.normal);
    let x = normalize(in.tangent.xyz - normal * dot(in.tangent.xyz, normal));
    let y = cross(normal, x) * select(-1.0, 1.0, in.tangent.w >= 0.0);
    let side = dot(normal, plane) * dot(plane, to_eye);
    return Tangents(x, y, normal * select(-1.0, 1.0, side >= 0.0));
}

fn into_material(tangents: Tangents, direction: vec3<f32>) -> vec3<f32> {
    return vec3<f32>(dot(direction, tangents.x), dot(direction, tangents.y), dot(direction, tangents.z));
}

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
    let count = min(btf_texture.samples, 4096u);
    if count == 0u {
        return vec3<f32>(0.0);
    }
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

@fragment
fn shade(in: Varying) -> @location(0) vec4<f32> {
    let detail = detail_of(dpdx(in.uv), dpdy(in.uv));
    let plane = cross(dpdx(in.position_mm), dpdy(in.position_mm));
    let to_eye = normalize(scene.eye_mm - in.position_mm);
    let tangents = tangents_of(in, plane, to_eye);
    let seen = seen_from(into_material(tangents, to_eye));
    var light = from_all_around(in, detail, seen, tangents);
    for (var i = 0u; i < scene.lights; i++) {
        let from_light = incident(i, in.position_mm);
        if dot(tangents.z, from_light.towards) > 0.0 {
            let reached = from_light.irradiance * visibility(i, in.position_mm, tangents.z);
            light += reached * textured(in.uv, detail, into_material(tangents, from_light.towards), seen);
        }
    }
    return vec4<f32>(encoded(neutral(light / PI * scene.exposure)), 1.0);
}
