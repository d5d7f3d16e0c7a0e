// Filtered layers over the patch (albedo, coefficients of the separable basis) at a point of a surface.

@group(1) @binding(0) var layers: texture_2d_array<f32>;
@group(1) @binding(1) var layer_sampler: sampler;

// Least share of a side of the box that is looked up.
const LEAST_SIDE: f32 = 0.01;

// Screen-space derivatives of the position in mm and of the texture coordinates.
struct Derivatives {
    dx: vec3<f32>,
    dy: vec3<f32>,
    uv_dx: vec2<f32>,
    uv_dy: vec2<f32>,
}

// Derivatives at a fragment; to be called in uniform control flow.
fn derivatives(position_mm: vec3<f32>, uv: vec2<f32>) -> Derivatives {
    return Derivatives(dpdx(position_mm), dpdy(position_mm), dpdx(uv), dpdy(uv));
}

// Layer l at a point in mm of the world, of a unit normal: by texture coordinates, or by box mapping, its sides blended by their shares.
fn layer_at(l: u32, position_mm: vec3<f32>, normal: vec3<f32>, uv: vec2<f32>, slopes: Derivatives) -> vec3<f32> {
    if object.is_boxed == 0u {
        return textureSampleGrad(layers, layer_sampler, uv, l, slopes.uv_dx, slopes.uv_dy).xyz;
    }
    let p = place_of(position_mm);
    let n = place_direction(normal);
    let dx = place_direction(slopes.dx);
    let dy = place_direction(slopes.dy);
    let sides = sides_of(n);
    let scale = object.patches_per_mm;
    var sum = vec3<f32>(0.0);
    if sides.x > LEAST_SIDE {
        let place = on_side_x(p, n);
        let value = textureSampleGrad(layers, layer_sampler, place, l, dx.zy * scale, dy.zy * scale);
        sum += sides.x * value.xyz;
    }
    if sides.y > LEAST_SIDE {
        let place = on_side_y(p, n);
        let value = textureSampleGrad(layers, layer_sampler, place, l, dx.xz * scale, dy.xz * scale);
        sum += sides.y * value.xyz;
    }
    if sides.z > LEAST_SIDE {
        let place = on_side_z(p, n);
        let value = textureSampleGrad(layers, layer_sampler, place, l, dx.xy * scale, dy.xy * scale);
        sum += sides.z * value.xyz;
    }
    return sum;
}
