// Light of the wide Gaussians at a position, from the light volume.

@group(1) @binding(5) var<uniform> volume: Volume;
// S_m of the Gaussians that spread in the volume.
@group(1) @binding(6) var volume_sums: TargetMaps;

// S_m at a position in mm, by the three cells about it along each axis.
fn volume_sums_at(position_mm: vec3<f32>) -> array<vec3<f32>, TERMS> {
    let place = clamp(place_in_volume(position_mm), vec3<f32>(0.0), vec3<f32>(volume.cells - 1));
    let middle = clamp(vec3<i32>(floor(place + 0.5)), vec3<i32>(1), volume.cells - 2);
    var total: array<vec3<f32>, TERMS>;
    for (var k = 0; k < 27; k++) {
        let cell = middle + vec3<i32>(k % 3, k / 3 % 3, k / 9) - 1;
        let texel = texel_of(cell);
        let near = spline(place - vec3<f32>(cell));
        for (var m = 0u; m < TERMS; m++) {
            total[m] += near.x * near.y * near.z * load_map(volume_sums, texel, m).xyz;
        }
    }
    return total;
}
