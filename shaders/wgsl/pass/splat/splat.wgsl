// Light of every sample that a light sees, spread over what lies around it: one ring of distances at a time, those further
// away from fewer samples and to fewer texels (Chen et al. 2012; Yatagawa et al. 2020, section 3.4).

struct Splat {
    // What softening by k / 2 pixels of the material takes from the light of a sample, as the factor that gives it back.
    softened: array<vec4<f32>, 8>,
    // From positions relative to the middle of the scene.
    clip_from_centre: mat4x4<f32>,
    // Distance in mm where the ring begins and ends to fade in; twice 0 for the first.
    fade_in: vec2<f32>,
    // Likewise out; both beyond the radius of scattering for the last.
    fade_out: vec2<f32>,
    // Half the size of something 1 mm large, 1 mm away, in clip space.
    focal: vec2<f32>,
    // Distance from the light to depth 0 in mm; 0 for a direction.
    middle_mm: f32,
    // Edge of a texel of this level at depth 0, in mm.
    texel_mm: f32,
    // Number of the light.
    light: u32,
    // Level of the samples, and texels to a side of it.
    level: u32,
    side: u32,
    // 1 if samples stand for those of the next level that are not smooth, 0 if for themselves where they are.
    refines: u32,
    // Texels of what the eye sees to a texel of the target.
    stride: u32,
    // Pixel of the material in mm.
    pitch_mm: f32,
    pad_0: u32,
    pad_1: u32,
}

@group(1) @binding(0) var<uniform> splat_of: Splat;
// What lights see, in levels.
@group(1) @binding(1) var seen_positions: texture_2d_array<f32>;
@group(1) @binding(2) var seen_fluxes: texture_2d_array<f32>;
@group(1) @binding(3) var seen_places: texture_2d_array<f32>;
// What the eye sees.
@group(1) @binding(4) var positions: texture_2d<f32>;
@group(1) @binding(5) var places: texture_2d<f32>;

struct Sample {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) position: vec3<f32>,
    // Flux in irradiance times mm^2.
    @location(1) @interpolate(flat) flux: vec3<f32>,
    // Of the material.
    @location(2) @interpolate(flat) pixel: vec4<u32>,
    // Distances are no less than this, in mm.
    @location(3) @interpolate(flat) softening_mm: f32,
}

// Steeper than this many texels deep, or partly empty, a texel is not smooth.
const STEEP: f32 = 1.0;
// Samples are softened by this share of their distance: peaks of the profiles would show where each of them is.
const SOFTENING: f32 = 0.6;

// Light of a sample whose distances are r -> sqrt(r^2 + s^2), given back what that takes.
fn given_back(softening_mm: f32) -> vec3<f32> {
    let at = min(softening_mm / (0.5 * splat_of.pitch_mm), 6.99);
    let k = u32(at);
    return mix(splat_of.softened[min(k, 7u)].xyz, splat_of.softened[min(k + 1u, 7u)].xyz, at - f32(k));
}

fn is_smooth(texel: vec2<u32>, level: u32, texel_mm: f32) -> bool {
    let range = textureLoad(seen_places, texel, splat_of.light, level).zw;
    let share = textureLoad(seen_fluxes, texel, splat_of.light, level).w;
    return share > 0.99 && range.y - range.x < STEEP * texel_mm;
}

// The texel of the patch at a place, which repeats or is mirrored.
fn patch_texel(place: vec2<f32>) -> vec2<u32> {
    let size = vec2<i32>(material.size);
    let x = vec2<i32>(floor(place * vec2<f32>(size)));
    let period = size * select(2, 1, material.addressing == 1u);
    // Made positive first: GLSL's remainder of negative numbers is another one.
    let m = (x + 4 * period) % period;
    if material.addressing == 1u {
        return min(vec2<u32>(m), material.size - 1u);
    }
    // What is no number may be anywhere: clamped once more.
    return min(vec2<u32>(min(m, period - 1 - m)), material.size - 1u);
}

@vertex
fn spread(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> Sample {
    let texel = min(vec2<u32>(instance % splat_of.side, instance / splat_of.side), vec2<u32>(splat_of.side - 1u));
    let flux = textureLoad(seen_fluxes, texel, splat_of.light, splat_of.level);
    let position = textureLoad(seen_positions, texel, splat_of.light, splat_of.level);
    var texel_mm = splat_of.texel_mm;
    if splat_of.middle_mm > 0.0 {
        texel_mm *= 1.0 + position.w / splat_of.middle_mm;
    }
    var wanted = flux.w > 0.0 && max(flux.x, max(flux.y, flux.z)) > 0.0;
    if splat_of.refines != 0u {
        wanted = wanted && !is_smooth(texel / 2u, splat_of.level + 1u, 2.0 * texel_mm);
    } else {
        wanted = wanted && is_smooth(texel, splat_of.level, texel_mm);
    }
    let centre = splat_of.clip_from_centre * vec4<f32>(position.xyz, 1.0);
    let radius = min(splat_of.fade_out.y, material.r_max_mm);
    // Nothing that is behind the eye can be seen.
    if !wanted || centre.w < -radius {
        return Sample(vec4<f32>(2.0, 2.0, 2.0, 1.0), vec3<f32>(0.0), vec3<f32>(0.0), vec4<u32>(0u), 0.0);
    }
    // A sphere of that radius, seen in perspective; close to the eye it may be everywhere.
    let distance = max(centre.w - radius, 0.02 * radius);
    let half_size = splat_of.focal * radius / distance;
    let side = vec2<f32>(vec2<u32>(corner & 1u, corner >> 1u)) * 2.0 - 1.0;
    let clip = centre.xy / max(centre.w, distance) + side * half_size;
    let place = textureLoad(seen_places, texel, splat_of.light, splat_of.level);
    var light = flux.xyz * texel_mm * texel_mm;
    var softening_mm = 0.0;
    if splat_of.fade_in.y == 0.0 {
        // Samples of a slanted surface are further apart than those across the light.
        let slope = min((place.w - place.z) / texel_mm, 2.0);
        softening_mm = SOFTENING * texel_mm * sqrt(1.0 + slope * slope);
        light *= given_back(softening_mm);
    }
    return Sample(vec4<f32>(clip, 0.5, 1.0), position.xyz, light, carried(patch_texel(place.xy)), softening_mm);
}

fn ring(r_mm: f32) -> f32 {
    let begun = select(1.0, smoothstep(splat_of.fade_in.x, splat_of.fade_in.y, r_mm), splat_of.fade_in.y > 0.0);
    return begun * (1.0 - smoothstep(splat_of.fade_out.x, splat_of.fade_out.y, r_mm));
}

@fragment
fn splat(in: Sample) -> @location(0) vec4<f32> {
    let size = textureDimensions(positions);
    let texel = min(vec2<u32>(in.clip.xy) * splat_of.stride + splat_of.stride / 2u, size - 1u);
    let seen = textureLoad(positions, texel, 0);
    let r_mm = distance(seen.xyz, in.position);
    let share = ring(r_mm);
    let softened_mm = sqrt(r_mm * r_mm + in.softening_mm * in.softening_mm);
    // Where nothing is seen, depth is far beyond everything.
    if softened_mm > material.r_max_mm || share <= 0.0 || seen.w > 50000.0 {
        return vec4<f32>(0.0);
    }
    // Rd of the pixels at both points (eq. 2 to 4), r their distance in space.
    let o = load_pixel(patch_texel(textureLoad(places, texel, 0).xy));
    let i = handed_over(in.pixel);
    let rd = reflectance(i, partner_at(o, softened_mm), vec2<i32>(0));
    // Half floats hold little more.
    return vec4<f32>(min(rd * in.flux * share, vec3<f32>(60000.0)), 0.0);
}
