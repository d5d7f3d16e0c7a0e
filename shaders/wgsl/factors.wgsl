// Factors of the material at a point of a surface: c_l, and the albedo under uniform light.

// c_l in mm^-1, a layer each, and the albedo in the layer after them; linear rgb.
@group(1) @binding(0) var factors: texture_2d_array<f32>;
@group(1) @binding(1) var factor_sampler: sampler;

// All c_l, and the albedo.
const FACTORS: u32 = TERMS + 1u;
// Sides of a box with less of a share than this are left out.
const LEAST_SIDE: f32 = 0.01;

struct Step {
    dx: vec3<f32>,
    dy: vec3<f32>,
    uv_dx: vec2<f32>,
    uv_dy: vec2<f32>,
}

// To be called where all fragments are.
fn step_of(position_mm: vec3<f32>, uv: vec2<f32>) -> Step {
    return Step(dpdx(position_mm), dpdy(position_mm), dpdx(uv), dpdy(uv));
}

// All factors, and the albedo last.
fn factors_at(p: vec3<f32>, n: vec3<f32>, uv: vec2<f32>, change: Step) -> array<vec3<f32>, FACTORS> {
    var sum: array<vec3<f32>, FACTORS>;
    if scene.is_boxed == 0u {
        for (var l = 0u; l < FACTORS; l++) {
            sum[l] = textureSampleGrad(factors, factor_sampler, uv, l, change.uv_dx, change.uv_dy).xyz;
        }
        return sum;
    }
    let sides = sides_of(n);
    let scale = scene.patches_per_mm;
    if sides.x > LEAST_SIDE {
        let place = on_side_x(p, n);
        for (var l = 0u; l < FACTORS; l++) {
            let value = textureSampleGrad(factors, factor_sampler, place, l, change.dx.zy * scale, change.dy.zy * scale);
            sum[l] += sides.x * value.xyz;
        }
    }
    if sides.y > LEAST_SIDE {
        let place = on_side_y(p, n);
        for (var l = 0u; l < FACTORS; l++) {
            let value = textureSampleGrad(factors, factor_sampler, place, l, change.dx.xz * scale, change.dy.xz * scale);
            sum[l] += sides.y * value.xyz;
        }
    }
    if sides.z > LEAST_SIDE {
        let place = on_side_z(p, n);
        for (var l = 0u; l < FACTORS; l++) {
            let value = textureSampleGrad(factors, factor_sampler, place, l, change.dx.xy * scale, change.dy.xy * scale);
            sum[l] += sides.z * value.xyz;
        }
    }
    return sum;
}
