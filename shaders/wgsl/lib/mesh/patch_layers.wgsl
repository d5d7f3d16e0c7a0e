// Filtered layers over the patch (albedo, coefficients of the separable basis) at a point of a surface.

@group(1) @binding(0) var layers: texture_2d_array<f32>;
@group(1) @binding(1) var layer_sampler: sampler;

// Least share of a second place that is looked up.
const LEAST_SHARE: f32 = 0.01;

// Places of a fragment, and their derivatives from pixel to pixel along rows and columns.
struct Lookup {
    places: Places,
    first_dx: vec2<f32>,
    first_dy: vec2<f32>,
    second_dx: vec2<f32>,
    second_dy: vec2<f32>,
}

// Lookup at a fragment; to be called in uniform control flow.
fn lookup_of(in: Varying) -> Lookup {
    let places = places_of(in.position_mm, in.sides, in.uv);
    let uv_dx = dpdx(in.uv);
    let uv_dy = dpdy(in.uv);
    if object.is_boxed == 0u {
        return Lookup(places, uv_dx, uv_dy, uv_dx, uv_dy);
    }
    let scale = object.patches_per_mm;
    let dx = (object.place_from_world * vec4<f32>(dpdx(in.position_mm), 0.0)).xyz;
    let dy = (object.place_from_world * vec4<f32>(dpdy(in.position_mm), 0.0)).xyz;
    return Lookup(
        places,
        across_side(places.sides.first, dx) * scale,
        across_side(places.sides.first, dy) * scale,
        across_side(places.sides.second, dx) * scale,
        across_side(places.sides.second, dy) * scale,
    );
}

// Layer l at a fragment, blended between its places.
fn layer_at(l: u32, at: Lookup) -> vec3<f32> {
    let first = textureSampleGrad(layers, layer_sampler, at.places.first, l, at.first_dx, at.first_dy).xyz;
    let rest = 1.0 - at.places.sides.share;
    if rest < LEAST_SHARE {
        return first;
    }
    let second = textureSampleGrad(layers, layer_sampler, at.places.second, l, at.second_dx, at.second_dy).xyz;
    return mix(first, second, rest);
}
