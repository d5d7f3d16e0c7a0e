// Domain of blurs in a light volume: cells along an axis, in texels of the slices.

@group(0) @binding(1) var<uniform> volume: Volume;
// Light in the cells, blurred by the stages and along the axes before.
@group(0) @binding(2) var maps: TargetMaps;

// All maps at the texel of a cell.
fn maps_at(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    var all: array<vec4<f32>, TERMS>;
    for (var l = 0u; l < TERMS; l++) {
        all[l] = load_map(maps, x, l);
    }
    return all;
}

// All maps, blurred at a texel along the axis of the stage. Outside there is no light.
fn blurred(x: vec2<i32>) -> array<vec4<f32>, TERMS> {
    let cell = cell_at(x);
    var sums: array<vec4<f32>, TERMS>;
    if cell.z >= volume.cells.z {
        return sums;
    }
    let along = vec3<i32>(stage.axis, 1 - stage.axis.x - stage.axis.y);
    let place = dot(cell, along);
    let last = dot(volume.cells, along) - 1;
    let first = max(-stage.taps, -place);
    let end = min(stage.taps, last - place);
    for (var k = first; k <= end; k++) {
        let distance = f32(k) / stage.sigma;
        // The sum of all weights, `step`, is that of taps on both sides.
        let weight = exp(-0.5 * distance * distance) / stage.step;
        let light = maps_at(texel_of(cell + k * along));
        for (var l = 0u; l < TERMS; l++) {
            sums[l] += weight * light[l];
        }
    }
    return sums;
}

// Whether there is a sum to add to: the first stage begins it.
fn has_sum() -> bool {
    return stage.has_sum != 0u;
}
