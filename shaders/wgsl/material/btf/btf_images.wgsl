// A BTF as it was measured: an image for every pair of a light and a view, linear between the directions around.

struct BtfImages {
    // Directions of lights lie on rings around the normal, evenly from azimuth 0 on: angle from the normal in rad, number
    // of directions, number of the first.
    light_rings: array<vec4<f32>, 16>,
    view_rings: array<vec4<f32>, 16>,
    // Rings of lights and of views.
    rings: vec2<u32>,
    // Pixels of an image.
    size: vec2<u32>,
    // Images to a row of a layer, which has those of all lights.
    tiles: u32,
    // Linear value of display white.
    white: f32,
    // cos theta of the lowest light.
    cos_light_min: f32,
    pad_0: u32,
}

@group(1) @binding(0) var<uniform> measured: BtfImages;
// Display values; a layer for each view.
@group(1) @binding(1) var images: texture_2d_array<f32>;

// The measured directions around one, on two rings.
struct Around {
    numbers: vec4<u32>,
    weights: vec4<f32>,
}

alias Seen = Around;

// What a texel looks like from a view.
struct Apparent {
    texel: u32,
}

fn apparent_of(texel: u32, seen: Seen) -> Apparent {
    return Apparent(texel);
}

// Two directions of a ring around an azimuth in turns, 0 to 1, and the weight of the second.
fn on_ring(ring: vec4<f32>, turns: f32) -> vec3<f32> {
    let at = turns * ring.y;
    let low = min(floor(at), ring.y - 1.0);
    let next = select(low + 1.0, 0.0, low + 1.5 > ring.y);
    return vec3<f32>(ring.z + low, ring.z + next, at - low);
}

// On the two rings around an angle from the normal.
fn around(direction: vec3<f32>, of_lights: bool) -> Around {
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
        // To the first ring that does not lie within.
        if outer.x < theta {
            inner = outer;
            outer = ring;
        }
    }
    let part = clamp((theta - inner.x) / max(outer.x - inner.x, 1e-6), 0.0, 1.0);
    let low = on_ring(inner, turns);
    let high = on_ring(outer, turns);
    return Around(
        vec4<u32>(vec4<f32>(low.xy, high.xy)),
        vec4<f32>((1.0 - part) * (1.0 - low.z), (1.0 - part) * low.z, part * (1.0 - high.z), part * high.z),
    );
}

fn seen_from(view: vec3<f32>) -> Seen {
    return around(view, false);
}

// pi times the radiance under light of unit irradiance on a plane that faces it: white paper has cos theta_i.
fn value_of(apparent: Apparent, light: vec3<f32>, seen: Seen) -> vec3<f32> {
    let above = max(light.z, 0.0);
    // Lights lower than those that were measured fade out.
    let fade = min(above / max(measured.cos_light_min, 1e-6), 1.0);
    var lit = around(light, true);
    var views = seen;
    let texel = apparent.texel;
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
    return measured.white * from_srgb(sum * fade);
}

// Images say nothing of how to sample them: lights are drawn in proportion to their cosine.
struct Sampler {
    unused: u32,
}

fn sampler_of(apparent: Apparent, seen: Seen) -> Sampler {
    return Sampler(0u);
}

fn sampled(source: Sampler, random: vec2<f32>) -> vec4<f32> {
    let sin_theta = sqrt(random.x);
    let cos_theta = sqrt(max(1.0 - random.x, 1e-6));
    let phi = 4.0 * HALF_PI * random.y;
    return vec4<f32>(sin_theta * cos(phi), sin_theta * sin(phi), cos_theta, cos_theta / (2.0 * HALF_PI));
}

fn density_of(source: Sampler, light: vec3<f32>) -> f32 {
    return max(light.z, 0.0) / (2.0 * HALF_PI);
}
