// Light that is transmitted through thin parts, from the translucent shadow maps or by the thickness that the host's maps tell.

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

// Remainder of c_l E of a plane that the light crosses, d mm behind it: sum over l and a of w_lma exp(-d^2 / 2 sigma_a^2) c_l E, but
// for the Gaussians that spread in the light volume.
fn attenuated(light: array<vec3<f32>, TERMS>, d: f32) -> array<vec3<f32>, TERMS> {
    // Only variables can be indexed by what is not constant.
    var entered = light;
    var left: array<vec3<f32>, TERMS>;
    for (var a = 0u; a < min(transmission.gaussians, volume.first); a++) {
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

// Standard deviation of the widest of them in mm.
fn widest_mm() -> f32 {
    return transmission.weights[min(4u * (min(transmission.gaussians, volume.first) - 1u), 31u)].w;
}

// Light of source i that enters d away along the light and reaches a position in mm, shape [m] (Dachsbacher and Stamminger
// 2003): a Gaussian of a plane falls with its distance by exp(-d^2 / 2 sigma^2).
fn transmitted_of_map(i: u32, position_mm: vec3<f32>) -> array<vec3<f32>, TERMS> {
    let coord = tsm_coord(i, position_mm);
    let depth = light_depth(i, position_mm);
    var total: array<vec3<f32>, TERMS>;
    let reach = spread_texels(widest_mm(), coord.texel_mm);
    for (var k = 0; k < 9; k++) {
        let step = vec2<i32>(k % 3 - 1, k / 3 - 1);
        let texel = tsm_texel(i, vec2<i32>(floor(coord.texel + vec2<f32>(step) * reach)));
        let flux = unpack(textureLoad(tsm_fluxes, texel, 0));
        let d = abs(depth - unpack(textureLoad(tsm_positions, texel, 0)).x);
        let uv = unpack(textureLoad(tsm_uvs, texel, 0)).xy;
        // Light that enters other groups does not come out of this one.
        let e = flux.xyz * select(0.0, 1.0, is_of_group(flux.w)) * spread_weight(step);
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

// The same by a map of the host's, which tells the distance alone: there the light is taken to meet the same material as here, as
// large an angle from the normal (Jimenez et al. 2010, "Real-time realistic skin translucency"). `facing_away` is the cosine here.
fn transmitted_by_host(
    i: u32,
    position_mm: vec3<f32>,
    facing_away: f32,
    c: array<vec3<f32>, LAYERS>,
) -> array<vec3<f32>, TERMS> {
    let from_light = incident(i, position_mm);
    let e = from_light.irradiance * fresnel_transmittance(facing_away, object.eta);
    // Only variables can be indexed by what is not constant.
    var here = c;
    var entered: array<vec3<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        entered[l] = here[l] * e;
    }
    var total: array<vec3<f32>, TERMS>;
    let coord = host_coord(i, position_mm);
    if !coord.is_inside {
        return total;
    }
    let ray = host_ray(i, position_mm, from_light.towards);
    let reach = spread_texels(widest_mm(), coord.texel_mm);
    for (var k = 0; k < 9; k++) {
        let step = vec2<i32>(k % 3 - 1, k / 3 - 1);
        let depth = host_depth(i, coord, floor(coord.texel + vec2<f32>(step) * reach));
        let d = thickness(ray, depth);
        if d >= 0.0 {
            var left = attenuated(entered, d);
            for (var m = 0u; m < TERMS; m++) {
                total[m] += spread_weight(step) * left[m];
            }
        }
    }
    return total;
}

// Light of source i that comes through from behind to a position in mm, shape [m]; `facing_away` is the cosine of the normal and the
// direction away from the light, `c` the coefficients of the basis. Where nothing tells the thickness, none does.
fn transmitted(
    i: u32,
    position_mm: vec3<f32>,
    facing_away: f32,
    c: array<vec3<f32>, LAYERS>,
) -> array<vec3<f32>, TERMS> {
    let shadow = scene.light[min(i, MAX_LIGHTS - 1u)].shadow;
    if shadow == OWN_SHADOW {
        return transmitted_of_map(i, position_mm);
    }
    if HOST_SHADOWS && shadow != NO_SHADOW {
        return transmitted_by_host(i, position_mm, facing_away, c);
    }
    return array<vec3<f32>, TERMS>();
}
