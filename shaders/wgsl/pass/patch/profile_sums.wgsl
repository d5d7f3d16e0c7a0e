// Needs: <target format>, <fitted material layout>, array, fullscreen.
// Two weighted sums over the log-scale profile of every pixel: y_l(x) = sum over k of d_lk exp(s_k P_x(r_k)). With s = 1/2 and
// the projection of a separable basis they are its coefficients c_l; with s = 1, an albedo.

// Texel 0: number of knots K. Then K texels of knots: node h, weight w of node h + 1, factor s. Then twice K texels of factors d
// for l = 0 and l = 1; linear Rec. 709.
@group(1) @binding(0) var sums: texture_2d<f32>;

// Largest magnitude of half floats.
const LARGEST: vec3<f32> = vec3<f32>(65504.0);

struct Sums {
    @location(0) first: TargetTexel,
    @location(1) second: TargetTexel,
}

// Entry k of the table, clamped to it.
fn entry(k: u32) -> vec3<f32> {
    return textureLoad(sums, min(array_texel(k), textureDimensions(sums) - 1u), 0).xyz;
}

@fragment
fn profile_sums(@builtin(position) at: vec4<f32>) -> Sums {
    let pixel = load_pixel(vec2<u32>(at.xy));
    let knots = u32(entry(0u).x);
    var first = vec3<f32>(0.0);
    var second = vec3<f32>(0.0);
    for (var k = 1u; k <= knots; k++) {
        let knot = entry(k);
        let h = min(u32(knot.x), material.samples - 2u);
        let value = exp(knot.z * log_profile(pixel, Knot(h, knot.y)));
        first += entry(knots + k) * value;
        second += entry(2u * knots + k) * value;
    }
    return Sums(
        // Depth 0, for the blurs.
        pack(vec4<f32>(clamp(first, -LARGEST, LARGEST), 0.0)),
        pack(vec4<f32>(clamp(second, -LARGEST, LARGEST), 0.0)),
    );
}
