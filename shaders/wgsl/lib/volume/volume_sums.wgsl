// Light of the wide Gaussians at a position, from the light volume.

@group(1) @binding(5) var<uniform> volume: Volume;
// S_m of the Gaussians that spread in the volume.
@group(1) @binding(6) var volume_sums: TargetMaps;

// S_m at a position in mm, between the middles of eight cells.
fn volume_sums_at(position_mm: vec3<f32>) -> array<vec3<f32>, TERMS> {
    let place = clamp(place_in_volume(position_mm), vec3<f32>(0.0), vec3<f32>(volume.cells - 1));
    let first = min(vec3<i32>(place), volume.cells - 2);
    let part = place - vec3<f32>(first);
    var total: array<vec3<f32>, TERMS>;
    for (var k = 0; k < 8; k++) {
        let corner = vec3<i32>(k & 1, (k >> 1u) & 1, k >> 2u);
        let texel = texel_of(first + corner);
        let near = mix(1.0 - part, part, vec3<f32>(corner));
        for (var m = 0u; m < TERMS; m++) {
            total[m] += near.x * near.y * near.z * load_map(volume_sums, texel, m).xyz;
        }
    }
    return total;
}
