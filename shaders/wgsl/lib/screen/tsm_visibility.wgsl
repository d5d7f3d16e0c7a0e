// Visibility of lights from their translucent shadow maps, or from the host's maps.

// Depth along the axis of the light in mm, and positions relative to the middle of the scene where there is room for them; a
// square tile for each light, row by row.
@group(0) @binding(1) var tsm_positions: TargetTexture;

// Visibility of light i from a position in mm, 0 to 1: percentage-closer filtering over three texels by three, with weights
// that move with the point (Reeves et al. 1987).
fn visibility(i: u32, position_mm: vec3<f32>, normal: vec3<f32>) -> f32 {
    let shadow = scene.light[min(i, MAX_LIGHTS - 1u)].shadow;
    if shadow == NO_SHADOW {
        return 1.0;
    }
    let towards = incident(i, position_mm).towards;
    // A texel of a slanted surface has depths on both sides of its middle.
    let cosine = clamp(dot(normal, towards), 0.15, 1.0);
    let slope = 0.6 + 1.5 * sqrt(1.0 - cosine * cosine) / cosine;
    if HOST_SHADOWS && shadow != OWN_SHADOW {
        return host_visibility(i, position_mm, towards, slope);
    }
    let coord = tsm_coord(i, position_mm);
    let slack = coord.texel_mm * slope;
    let depth = light_depth(i, position_mm) - slack;
    let corner = coord.texel - 0.5;
    let first = vec2<i32>(floor(corner));
    let part = corner - floor(corner);
    var sum = 0.0;
    for (var y = -1; y <= 2; y++) {
        for (var x = -1; x <= 2; x++) {
            let stored = unpack(textureLoad(tsm_positions, tsm_texel(i, first + vec2<i32>(x, y)), 0)).x;
            let weight = clamp(vec2<f32>(2.0) - abs(vec2<f32>(f32(x), f32(y)) - part), vec2<f32>(0.0), vec2<f32>(1.0));
            sum += weight.x * weight.y * select(0.0, 1.0, stored >= depth);
        }
    }
    return sum / 9.0;
}
