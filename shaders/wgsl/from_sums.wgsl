// Exitance from blurred maps on the screen: M = sum over m of c_m S_m, light that comes through, and the environment's.

struct Sums {
    // w_lma pitch^2, shape [a][l][m] with room for two terms; rgb, and sigma_a in mm in the fourth place.
    weights: array<vec4<f32>, 32>,
    // Texels of the maps to a pixel of the picture.
    texels_per_pixel: vec2<f32>,
    // A.
    gaussians: u32,
    // Half a texel of the maps at the middle of the scene, in mm: differences of depth count in this.
    texel_mm: f32,
}

@group(1) @binding(2) var<uniform> through: Sums;
// S_m, and depth in the fourth place.
@group(1) @binding(3) var sums: texture_2d_array<f32>;
// What lights see: irradiance that enters, on a plane across the axis.
@group(1) @binding(4) var seen_fluxes: texture_2d_array<f32>;
// Place on the patch.
@group(1) @binding(5) var seen_places: texture_2d_array<f32>;

// S_m at a pixel: linear between texels, those at other depths left out.
fn sums_at(pixel: vec2<f32>, depth: f32) -> array<vec3<f32>, TERMS> {
    let size = vec2<i32>(textureDimensions(sums));
    let corner = pixel * through.texels_per_pixel - 0.5;
    let first = vec2<i32>(floor(corner));
    let part = corner - floor(corner);
    var total: array<vec3<f32>, TERMS>;
    var weights = 0.0;
    for (var k = 0u; k < 4u; k++) {
        let step = vec2<i32>(i32(k & 1u), i32(k >> 1u));
        let texel = clamp(first + step, vec2<i32>(0), size - 1);
        let value = textureLoad(sums, texel, 0u, 0);
        let linear = mix(1.0 - part, part, vec2<f32>(step));
        let apart = (value.w - depth) / through.texel_mm;
        let weight = linear.x * linear.y / (1.0 + apart * apart) + 1e-5 / (1.0 + abs(apart));
        weights += weight;
        total[0] += weight * value.xyz;
        for (var m = 1u; m < TERMS; m++) {
            total[m] += weight * textureLoad(sums, texel, m, 0).xyz;
        }
    }
    for (var m = 0u; m < TERMS; m++) {
        total[m] /= weights;
    }
    return total;
}

// What is left of c_l E of a plane that the light crosses, after d mm: sum over l and a of w_lma exp(-d^2 / 2 sigma_a^2) c_l E.
fn passed(light: array<vec3<f32>, TERMS>, d: f32) -> array<vec3<f32>, TERMS> {
    // Only variables can be indexed by what is not constant.
    var entered = light;
    var left: array<vec3<f32>, TERMS>;
    for (var a = 0u; a < through.gaussians; a++) {
        let sigma = through.weights[min(4u * a, 31u)].w;
        let share = exp(-0.5 * min(d * d / (sigma * sigma), 80.0));
        for (var l = 0u; l < TERMS; l++) {
            for (var m = 0u; m < TERMS; m++) {
                left[m] += share * through.weights[min(4u * a + 2u * l + m, 31u)].xyz * entered[l];
            }
        }
    }
    return left;
}

// Light of one source that comes through from where it enters, d away along the light (Dachsbacher and Stamminger 2003):
// a Gaussian of a plane at a distance is what it is along the way, exp(-d^2 / 2 sigma^2).
fn come_through(i: u32, position_mm: vec3<f32>) -> array<vec3<f32>, TERMS> {
    let sight = sight_of(i, position_mm);
    let depth = light_depth(i, position_mm);
    var total: array<vec3<f32>, TERMS>;
    // Light spreads on its way: five places, as far apart as it has gone.
    let nearest = textureLoad(seen_positions, seen_texel(vec2<i32>(floor(sight.texel))), i, 0).w;
    let spread = clamp(0.5 * (depth - nearest) / sight.texel_mm, 1.0, 24.0);
    for (var k = 0; k < 5; k++) {
        let aside = vec2<f32>(vec2<i32>(k - 2, ((k * 2 + 2) % 5) - 2)) * 0.7 * spread;
        let texel = seen_texel(vec2<i32>(floor(sight.texel + aside)));
        let flux = textureLoad(seen_fluxes, texel, i, 0);
        let d = max(depth - textureLoad(seen_positions, texel, i, 0).w, 0.0);
        let place = textureLoad(seen_places, texel, i, 0).xy;
        // Nothing was seen there if the fourth value is 0.
        let e = flux.xyz * flux.w * 0.2;
        var light: array<vec3<f32>, TERMS>;
        for (var l = 0u; l < TERMS; l++) {
            light[l] = e * textureSampleLevel(layers, layer_sampler, place, l, 1.0).xyz;
        }
        var left = passed(light, d);
        for (var m = 0u; m < TERMS; m++) {
            total[m] += left[m];
        }
    }
    return total;
}

fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    let change = step_of(in.position_mm, in.uv);
    var c = factors_at(in.position_mm, normal, in.uv, change);
    var light = sums_at(in.clip.xy, depth_of(in.position_mm));
    for (var i = 0u; i < scene.lights; i++) {
        // What faces the light has it in the blurred maps already.
        let facing_away = clamp(-dot(normal, incident(i, in.position_mm).towards), 0.0, 1.0);
        if facing_away > 0.0 {
            var came = come_through(i, in.position_mm);
            for (var m = 0u; m < TERMS; m++) {
                light[m] += facing_away * came[m];
            }
        }
    }
    var sum = c[TERMS] * scattered_sky(in, normal);
    for (var m = 0u; m < TERMS; m++) {
        sum += c[m] * light[m];
    }
    return max(sum, vec3<f32>(0.0));
}

fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}
