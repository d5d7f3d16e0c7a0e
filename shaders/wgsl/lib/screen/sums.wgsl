// Sums over the Gaussians or terms of blurs on the screen, at a pixel of the picture. The pass has `sums`, with depth in mm in the
// fourth channel.

// S_m at a pixel of the picture, from texels of about its depth in mm.
fn sums_at(pixel: vec2<f32>, depth: f32) -> array<vec3<f32>, TERMS> {
    let coord = bilinear_coord(pixel);
    var total: array<vec3<f32>, TERMS>;
    var weights = 0.0;
    for (var k = 0u; k < NEIGHBOURS; k++) {
        if k == 4u && weights > ENOUGH {
            break;
        }
        let texel = clamp(coord.first + neighbour(k), vec2<i32>(0), upsampling.last);
        let value = load_map(sums, texel, 0u);
        let weight = near_weight(linear_weight(k, coord.part), (value.w - depth) / upsampling.near_mm);
        weights += weight;
        total[0] += weight * value.xyz;
        for (var m = 1u; m < TERMS; m++) {
            total[m] += weight * load_map(sums, texel, m).xyz;
        }
    }
    for (var m = 0u; m < TERMS; m++) {
        total[m] /= weights;
    }
    return total;
}
