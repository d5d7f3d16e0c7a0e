// Light that comes through thin parts, from where a light sees it enter.

struct Through {
    // w_lma pitch^2, shape [a][l][m] with room for two terms; rgb, and sigma_a in mm in the fourth place.
    weights: array<vec4<f32>, 32>,
    // A.
    gaussians: u32,
    pad_0: u32,
    pad_1: u32,
    pad_2: u32,
}

@group(1) @binding(2) var<uniform> through: Through;
// What lights see: irradiance that enters, on a plane across the axis.
@group(1) @binding(3) var seen_fluxes: KeptLayers;
// Place on the patch.
@group(1) @binding(4) var seen_places: KeptLayers;

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
    // Light spreads on its way: nine places around it, as far apart as the widest Gaussian reaches from one to the next.
    let widest_mm = through.weights[min(4u * (through.gaussians - 1u), 31u)].w;
    let spread = clamp(0.8 * widest_mm / sight.texel_mm, 1.0, 128.0);
    for (var k = 0; k < 9; k++) {
        let step = vec2<i32>(k % 3 - 1, k / 3 - 1);
        let texel = seen_texel(vec2<i32>(floor(sight.texel + vec2<f32>(step) * spread)));
        let flux = told(textureLoad(seen_fluxes, texel, i, 0));
        let d = abs(depth - told(textureLoad(seen_positions, texel, i, 0)).w);
        let place = told(textureLoad(seen_places, texel, i, 0)).xy;
        // Binomial weights. Nothing was seen there if the fourth value is 0.
        let e = flux.xyz * flux.w * f32((2 - abs(step.x)) * (2 - abs(step.y))) / 16.0;
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
