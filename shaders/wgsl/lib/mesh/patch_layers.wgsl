// Layers of filtered values over the patch, at a point of a surface.

@group(1) @binding(0) var layers: texture_2d_array<f32>;
@group(1) @binding(1) var layer_sampler: sampler;

// Sides of a box with less of a share than this are left out.
const LEAST_SIDE: f32 = 0.01;

// How position and texture coordinates change from pixel to pixel.
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

// One layer: by texture coordinates, or from the sides of a box by their shares.
fn layer_at(l: u32, p: vec3<f32>, n: vec3<f32>, uv: vec2<f32>, change: Step) -> vec3<f32> {
    if scene.is_boxed == 0u {
        return textureSampleGrad(layers, layer_sampler, uv, l, change.uv_dx, change.uv_dy).xyz;
    }
    let sides = sides_of(n);
    let scale = scene.patches_per_mm;
    var sum = vec3<f32>(0.0);
    if sides.x > LEAST_SIDE {
        let place = on_side_x(p, n);
        let value = textureSampleGrad(layers, layer_sampler, place, l, change.dx.zy * scale, change.dy.zy * scale);
        sum += sides.x * value.xyz;
    }
    if sides.y > LEAST_SIDE {
        let place = on_side_y(p, n);
        let value = textureSampleGrad(layers, layer_sampler, place, l, change.dx.xz * scale, change.dy.xz * scale);
        sum += sides.y * value.xyz;
    }
    if sides.z > LEAST_SIDE {
        let place = on_side_z(p, n);
        let value = textureSampleGrad(layers, layer_sampler, place, l, change.dx.xy * scale, change.dy.xy * scale);
        sum += sides.z * value.xyz;
    }
    return sum;
}
