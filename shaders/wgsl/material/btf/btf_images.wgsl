// Storage of a BTF as it was measured: an image for every pair of a light and a view, linear between directions.

struct BtfImages {
    // Rings of directions of lights around the normal, evenly from azimuth 0 on: angle from the normal in rad, number of
    // directions, number of the first.
    light_rings: array<vec4<f32>, 16>,
    // Rings of directions of views.
    view_rings: array<vec4<f32>, 16>,
    // Numbers of rings of lights and of views.
    rings: vec2<u32>,
    // Pixels of an image, columns and rows.
    size: vec2<u32>,
    // Images to a row of a layer, which holds those of all lights.
    tiles: u32,
    // Radiance value of display white, linear.
    white: f32,
    // Cosine of the angle from the normal of the lowest light.
    cos_light_min: f32,
    pad_0: u32,
}

@group(1) @binding(0) var<uniform> measured: BtfImages;
// Images as sRGB values, a layer for each view.
@group(1) @binding(1) var images: texture_2d_array<f32>;

// The four measured directions around one, on two rings, and their weights, of sum 1.
struct RingCoord {
    numbers: vec4<u32>,
    weights: vec4<f32>,
}

alias ViewCoord = RingCoord;

// Apparent BRDF of a texel: its number, row by row.
struct ApparentBrdf {
    texel: u32,
}

// Apparent BRDF of a texel from a view.
fn apparent_brdf(texel: u32, eye: ViewCoord) -> ApparentBrdf {
    return ApparentBrdf(texel);
}

// Numbers of two directions of a ring around an azimuth in turns, 0 to 1, and the weight of the second.
fn ring_neighbours(ring: vec4<f32>, turns: f32) -> vec3<f32> {
    let at = turns * ring.y;
    let low = min(floor(at), ring.y - 1.0);
    let next = select(low + 1.0, 0.0, low + 1.5 > ring.y);
    return vec3<f32>(ring.z + low, ring.z + next, at - low);
}

// Measured directions around a unit vector.
fn ring_coord(direction: vec3<f32>, of_lights: bool) -> RingCoord {
    let theta = angle_of(length(direction.xy), direction.z);
    let turn = angle_of(direction.y, direction.x) / (4.0 * HALF_PI);
    let turns = select(turn, turn + 1.0, turn < 0.0);
    let count = min(select(measured.rings.y, measured.rings.x, of_lights), 16u);
    var inner = measured.view_rings[0];
    if of_lights {
        inner = measured.light_rings[0];
    }
    var outer = inner;
    for (var k = 1u; k < count; k++) {
        var ring = measured.view_rings[k];
        if of_lights {
            ring = measured.light_rings[k];
        }
        // Up to the first ring that is not within the angle.
        if outer.x < theta {
            inner = outer;
            outer = ring;
        }
    }
    let part = clamp((theta - inner.x) / max(outer.x - inner.x, 1e-6), 0.0, 1.0);
    let low = ring_neighbours(inner, turns);
    let high = ring_neighbours(outer, turns);
    return RingCoord(
        vec4<u32>(vec4<f32>(low.xy, high.xy)),
        vec4<f32>((1.0 - part) * (1.0 - low.z), (1.0 - part) * low.z, part * (1.0 - high.z), part * high.z),
    );
}

// Measured directions around a unit vector towards the eye.
fn view_coord(view: vec3<f32>) -> ViewCoord {
    return ring_coord(view, false);
}

// Value of a BTF: pi times the radiance under light of unit irradiance on a plane that faces it (a white diffuser has
// cos theta_i), linear Rec. 709; `light` is a unit vector.
fn btf_value(brdf: ApparentBrdf, light: vec3<f32>, eye: ViewCoord) -> vec3<f32> {
    let above = max(light.z, 0.0);
    // Lights lower than those that were measured fade out.
    let fade = min(above / max(measured.cos_light_min, 1e-6), 1.0);
    var lit = ring_coord(light, true);
    var views = eye;
    let texel = brdf.texel;
    let at = vec2<u32>(texel % measured.size.x, min(texel / measured.size.x, measured.size.y - 1u));
    let last = vec2<u32>(textureDimensions(images)) - 1u;
    var sum = vec3<f32>(0.0);
    for (var i = 0u; i < 4u; i++) {
        let tile = vec2<u32>(lit.numbers[i] % measured.tiles, lit.numbers[i] / measured.tiles);
        let place = min(tile * measured.size + at, last);
        for (var v = 0u; v < 4u; v++) {
            let layer = min(views.numbers[v], u32(textureNumLayers(images)) - 1u);
            sum += lit.weights[i] * views.weights[v] * textureLoad(images, place, layer, 0).xyz;
        }
    }
    return measured.white * linear_from_srgb(sum * fade);
}

// Sampler of lights: images do not help to sample them, so their density is proportional to the cosine.
struct LightSampler {
    unused: u32,
}

// Sampler of a texel from a view.
fn light_sampler(brdf: ApparentBrdf, eye: ViewCoord) -> LightSampler {
    return LightSampler(0u);
}

// Unit vector towards a light for two random numbers, 0 to 1, and its density per steradian.
fn sample_light(source: LightSampler, random: vec2<f32>) -> vec4<f32> {
    let sin_theta = sqrt(random.x);
    let cos_theta = sqrt(max(1.0 - random.x, 1e-6));
    let phi = 4.0 * HALF_PI * random.y;
    return vec4<f32>(sin_theta * cos(phi), sin_theta * sin(phi), cos_theta, cos_theta / (2.0 * HALF_PI));
}

// Density of a light per steradian.
fn light_density(source: LightSampler, light: vec3<f32>) -> f32 {
    return max(light.z, 0.0) / (2.0 * HALF_PI);
}
