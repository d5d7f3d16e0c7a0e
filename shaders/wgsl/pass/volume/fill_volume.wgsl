// Needs: <target format>, <terms>, scene, fullscreen, volume.
// Light that enters, sums of c_l E dA about each cell of a light volume, from samples of the lights' own views.

@group(0) @binding(1) var tsm_positions: TargetTexture;
@group(1) @binding(0) var layers: texture_2d_array<f32>;
@group(1) @binding(1) var layer_sampler: sampler;
@group(1) @binding(2) var<uniform> volume: Volume;
@group(1) @binding(3) var tsm_fluxes: TargetTexture;
@group(1) @binding(4) var tsm_uvs: TargetTexture;

// Samples of a light's view to a side of a cell, about.
const SAMPLES: f32 = 1.5;

// Position in mm of a texel of light i's view, not rounded, at a depth along its axis in mm: between the nearest and the furthest on
// its ray.
fn seen_position(i: u32, texel: vec2<f32>, depth: f32) -> vec3<f32> {
    let place = (2.0 * texel / f32(scene.light_texels) - 1.0) * vec2<f32>(1.0, -1.0);
    let near = volume.world_from_clip[min(i, MAX_LIGHTS - 1u)] * vec4<f32>(place, 0.0, 1.0);
    let far = volume.world_from_clip[min(i, MAX_LIGHTS - 1u)] * vec4<f32>(place, 1.0, 1.0);
    let start = near.xyz / near.w;
    let ray = far.xyz / far.w - start;
    let nearest = light_depth(i, start);
    return start + ray * (depth - nearest) / (light_depth(i, start + ray) - nearest);
}

// As far as splines reach in cells: along an axis of the volume, and at its corners.
const REACH: f32 = 1.5;
const DIAGONAL: f32 = 2.6;

// Sum of the absolute values of a vector.
fn total_of(v: vec3<f32>) -> f32 {
    return dot(abs(v), vec3<f32>(1.0));
}

// How far splines reach about a cell in the view of light i, in texels of `texel_mm`.
fn reach_of(source: LightSource, texel_mm: f32) -> vec2<f32> {
    if source.is_local != 0u {
        return vec2<f32>(DIAGONAL * volume.cell_mm / texel_mm);
    }
    // The clip coordinates of the corners.
    let rows = transpose(source.clip_from_world);
    let reach = vec2<f32>(total_of(rows[0].xyz), total_of(rows[1].xyz)) * REACH * volume.cell_mm;
    return 0.5 * f32(scene.light_texels) * reach;
}

// Share in a cell of the light that enters at a texel of light i's view, c_l E times the area of the texel in mm^2; by coefficients
// of a mipmap level. `middle` is the depth of the cell.
fn sample_of(i: u32, of_tile: vec2<i32>, level: f32, cell: vec3<i32>, middle: f32) -> array<vec3<f32>, TERMS> {
    var light: array<vec3<f32>, TERMS>;
    let texel = tsm_texel(i, of_tile);
    let depth = unpack(textureLoad(tsm_positions, texel, 0)).x;
    // Most of what a light sees above a cell is far from it.
    if abs(depth - middle) > DIAGONAL * volume.cell_mm {
        return light;
    }
    let place = place_in_volume(seen_position(i, vec2<f32>(of_tile) + 0.5, depth));
    let near = spline(place - vec3<f32>(cell));
    let share = near.x * near.y * near.z;
    if share == 0.0 {
        return light;
    }
    let flux = unpack(textureLoad(tsm_fluxes, texel, 0));
    // Light that enters other groups does not come out of this one.
    let source = scene.light[min(i, MAX_LIGHTS - 1u)];
    let edge_mm = source.texel_mm * select(1.0, 1.0 + depth / source.middle_mm, source.is_local != 0u);
    let e = flux.xyz * select(0.0, share * edge_mm * edge_mm, abs(flux.w - volume.group) < 0.5);
    let uv = unpack(textureLoad(tsm_uvs, texel, 0)).xy;
    for (var l = 0u; l < TERMS; l++) {
        light[l] = e * textureSampleLevel(layers, layer_sampler, uv, l, level).xyz;
    }
    return light;
}

@fragment
fn fill_volume(@builtin(position) at: vec4<f32>) -> Maps {
    var total: array<vec4<f32>, TERMS>;
    let cell = cell_at(vec2<i32>(at.xy));
    if cell.z >= volume.cells.z {
        return maps_of(total);
    }
    let middle_mm = volume.origin_mm + volume.cell_mm * vec3<f32>(cell);
    for (var i = 0u; i < scene.lights; i++) {
        // Samples to a side of the view, and texels from one to the next.
        let source = scene.light[min(i, MAX_LIGHTS - 1u)];
        let texels = f32(scene.light_texels);
        let side = ceil(clamp(texels * SAMPLES * source.texel_mm / volume.cell_mm, min(4.0, texels), texels));
        let stride = texels / side;
        // The level that is about as coarse as samples.
        let level = max(log2(stride * source.texel_mm / volume.pitch_mm), 0.0);
        let coord = tsm_coord(i, middle_mm);
        if coord.texel_mm <= 0.0 {
            // Not before the light.
            continue;
        }
        // In samples.
        let reach = reach_of(source, coord.texel_mm) / stride;
        let middle = coord.texel / stride - 0.5;
        let first = vec2<i32>(ceil(clamp(middle - reach, vec2<f32>(0.0), vec2<f32>(side))));
        let last = vec2<i32>(floor(clamp(middle + reach, vec2<f32>(-1.0), vec2<f32>(side - 1.0))));
        let depth = light_depth(i, middle_mm);
        // A sample stands for as many texels as samples are apart; in cells.
        let edge = stride / volume.cell_mm;
        for (var y = first.y; y <= last.y; y++) {
            for (var x = first.x; x <= last.x; x++) {
                let light = sample_of(i, vec2<i32>((vec2<f32>(vec2<i32>(x, y)) + 0.5) * stride), level, cell, depth);
                total[0] += vec4<f32>(edge * edge * light[0], 0.0);
                total[TERMS - 1u] += vec4<f32>(select(0.0, edge * edge, TERMS > 1u) * light[TERMS - 1u], 0.0);
            }
        }
    }
    for (var l = 0u; l < TERMS; l++) {
        total[l] = vec4<f32>(clamp(total[l].xyz, -BRIGHTEST, BRIGHTEST), 0.0);
    }
    return maps_of(total);
}
