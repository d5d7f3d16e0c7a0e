// Visibility of lights, and thickness of what they shine through, from depth maps of the host's own.

// Whether lights may have such maps.
override HOST_SHADOWS: bool = true;

// Depth maps, by number; where there is none, a texture of one texel.
@group(3) @binding(0) var host_map_0: texture_2d<f32>;
@group(3) @binding(1) var host_map_1: texture_2d<f32>;
@group(3) @binding(2) var host_map_2: texture_2d<f32>;
@group(3) @binding(3) var host_map_3: texture_2d<f32>;
@group(3) @binding(4) var host_map_4: texture_2d<f32>;
@group(3) @binding(5) var host_map_5: texture_2d<f32>;
@group(3) @binding(6) var host_map_6: texture_2d<f32>;
@group(3) @binding(7) var host_map_7: texture_2d<f32>;
// Does not filter: GLES 3.0 reads depth in no other way.
@group(3) @binding(8) var host_sampler: sampler;

// Texels of a map, columns and rows.
fn host_map_size(number: u32) -> vec2<f32> {
    switch number {
        case 0u: { return vec2<f32>(textureDimensions(host_map_0)); }
        case 1u: { return vec2<f32>(textureDimensions(host_map_1)); }
        case 2u: { return vec2<f32>(textureDimensions(host_map_2)); }
        case 3u: { return vec2<f32>(textureDimensions(host_map_3)); }
        case 4u: { return vec2<f32>(textureDimensions(host_map_4)); }
        case 5u: { return vec2<f32>(textureDimensions(host_map_5)); }
        case 6u: { return vec2<f32>(textureDimensions(host_map_6)); }
        default: { return vec2<f32>(textureDimensions(host_map_7)); }
    }
}

// Depth of a map at texture coordinates.
fn host_map_at(number: u32, uv: vec2<f32>) -> f32 {
    switch number {
        case 0u: { return textureSampleLevel(host_map_0, host_sampler, uv, 0.0).x; }
        case 1u: { return textureSampleLevel(host_map_1, host_sampler, uv, 0.0).x; }
        case 2u: { return textureSampleLevel(host_map_2, host_sampler, uv, 0.0).x; }
        case 3u: { return textureSampleLevel(host_map_3, host_sampler, uv, 0.0).x; }
        case 4u: { return textureSampleLevel(host_map_4, host_sampler, uv, 0.0).x; }
        case 5u: { return textureSampleLevel(host_map_5, host_sampler, uv, 0.0).x; }
        case 6u: { return textureSampleLevel(host_map_6, host_sampler, uv, 0.0).x; }
        default: { return textureSampleLevel(host_map_7, host_sampler, uv, 0.0).x; }
    }
}

// Place of a position in the map of a light.
struct HostCoord {
    // Texel, not rounded, and texels of the map.
    texel: vec2<f32>,
    size: vec2<f32>,
    // Edge of a texel there, the longer one, in mm.
    texel_mm: f32,
    is_inside: bool,
}

// Place of a position in mm in the map of light i.
fn host_coord(i: u32, position_mm: vec3<f32>) -> HostCoord {
    let source = scene.light[min(i, MAX_LIGHTS - 1u)];
    let size = host_map_size(source.map);
    let clip = source.clip_from_world * vec4<f32>(position_mm, 1.0);
    let place = clip.xy / clip.w;
    // Steps of the place for a mm: derivatives of the quotient.
    let rows = transpose(source.clip_from_world);
    let dx = (rows[0].xyz - place.x * rows[3].xyz) / clip.w;
    let dy = (rows[1].xyz - place.y * rows[3].xyz) / clip.w;
    let texel_mm = 2.0 / max(min(size.x * length(dx), size.y * length(dy)), 1e-12);
    let is_inside = clip.w > 0.0 && max(abs(place.x), abs(place.y)) <= 1.0;
    return HostCoord((place * vec2<f32>(0.5, -0.5) + 0.5) * size, size, texel_mm, is_inside);
}

// Depth in the map of light i at a texel, clamped to it.
fn host_depth(i: u32, coord: HostCoord, texel: vec2<f32>) -> f32 {
    let clamped = clamp(texel, vec2<f32>(0.0), coord.size - 1.0);
    return host_map_at(scene.light[min(i, MAX_LIGHTS - 1u)].map, (clamped + 0.5) / coord.size);
}

// Visibility of light i from a position in mm, 0 to 1, filtered as that from our own maps; `slope` is in edges of texels. Nothing
// beyond the map is in shadow.
fn host_visibility(i: u32, position_mm: vec3<f32>, towards: vec3<f32>, slope: f32) -> f32 {
    let source = scene.light[min(i, MAX_LIGHTS - 1u)];
    let coord = host_coord(i, position_mm);
    if !coord.is_inside {
        return 1.0;
    }
    let nearer = source.clip_from_world * vec4<f32>(position_mm + coord.texel_mm * slope * towards, 1.0);
    // Steps beyond a light that is close meet nothing before it.
    if nearer.w <= 0.0 {
        return 1.0;
    }
    let depth = clamp(nearer.z / nearer.w, 0.0, 1.0);
    // What is reversed is compared with its sign reversed.
    let sign = select(1.0, -1.0, source.shadow == HOST_SHADOW_REVERSED);
    let corner = coord.texel - 0.5;
    let first = floor(corner);
    let part = corner - first;
    var sum = 0.0;
    for (var y = -1; y <= 2; y++) {
        for (var x = -1; x <= 2; x++) {
            let tap = vec2<f32>(f32(x), f32(y));
            let weight = clamp(vec2<f32>(2.0) - abs(tap - part), vec2<f32>(0.0), vec2<f32>(1.0));
            let is_lit = sign * host_depth(i, coord, first + tap) >= sign * depth;
            sum += weight.x * weight.y * select(0.0, 1.0, is_lit);
        }
    }
    return sum / 9.0;
}
