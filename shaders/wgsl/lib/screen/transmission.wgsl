// Light that is transmitted through thin parts, from the translucent shadow maps.

struct Transmission {
    // w_lma, shape [a][l][m] with room for two terms; linear Rec. 709, and sigma_a in mm in the fourth place.
    weights: array<vec4<f32>, 32>,
    // A, the number of Gaussians, 1 to 8.
    gaussians: u32,
    pad_0: u32,
    pad_1: u32,
    pad_2: u32,
}

@group(1) @binding(2) var<uniform> transmission: Transmission;
// Irradiance that enters, on a plane across the axis of the light.
@group(1) @binding(3) var tsm_fluxes: TargetTexture;
// Texture coordinates on the patch.
@group(1) @binding(4) var tsm_uvs: TargetTexture;

// Remainder of c_l E of a plane that the light crosses, d mm behind it: sum over l and a of w_lma exp(-d^2 / 2 sigma_a^2) c_l E.
fn attenuated(light: array<vec3<f32>, TERMS>, d: f32) -> array<vec3<f32>, TERMS> {
    // Only variables can be indexed by what is not constant.
    var entered = light;
    var left: array<vec3<f32>, TERMS>;
    for (var a = 0u; a < transmission.gaussians; a++) {
        let sigma = transmission.weights[min(4u * a, 31u)].w;
        let share = exp(-0.5 * min(d * d / (sigma * sigma), 80.0));
        for (var l = 0u; l < TERMS; l++) {
            for (var m = 0u; m < TERMS; m++) {
                left[m] += share * transmission.weights[min(4u * a + 2u * l + m, 31u)].xyz * entered[l];
            }
        }
    }
    return left;
}

// Light of source i that enters d away along the light and reaches a position in mm, shape [m] (Dachsbacher and Stamminger
// 2003): a Gaussian of a plane falls with its distance by exp(-d^2 / 2 sigma^2).
fn transmitted(i: u32, position_mm: vec3<f32>) -> array<vec3<f32>, TERMS> {
    let coord = tsm_coord(i, position_mm);
    let depth = light_depth(i, position_mm);
    var total: array<vec3<f32>, TERMS>;
    // Light spreads on its way: nine places around it, as far apart as the widest Gaussian reaches from one to the next.
    let widest_mm = transmission.weights[min(4u * (transmission.gaussians - 1u), 31u)].w;
    let reach = clamp(0.8 * widest_mm / coord.texel_mm, 1.0, 128.0);
    for (var k = 0; k < 9; k++) {
        let step = vec2<i32>(k % 3 - 1, k / 3 - 1);
        let texel = tsm_texel(i, vec2<i32>(floor(coord.texel + vec2<f32>(step) * reach)));
        let flux = unpack(textureLoad(tsm_fluxes, texel, 0));
        let d = abs(depth - unpack(textureLoad(tsm_positions, texel, 0)).x);
        let uv = unpack(textureLoad(tsm_uvs, texel, 0)).xy;
        // Binomial weights. Light that enters other groups does not come out of this one.
        let e = flux.xyz * select(0.0, 1.0, is_of_group(flux.w)) * f32((2 - abs(step.x)) * (2 - abs(step.y))) / 16.0;
        var light: array<vec3<f32>, TERMS>;
        for (var l = 0u; l < TERMS; l++) {
            light[l] = e * textureSampleLevel(layers, layer_sampler, uv, l, 1.0).xyz;
        }
        var left = attenuated(light, d);
        for (var m = 0u; m < TERMS; m++) {
            total[m] += left[m];
        }
    }
    return total;
}
