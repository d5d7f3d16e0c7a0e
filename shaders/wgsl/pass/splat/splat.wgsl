// Needs: <fitted material layout>.
// Splats: light of every sample of a translucent shadow map, spread over what lies around it, one ring of distances at a time;
// further rings have fewer samples and fewer texels (Chen et al. 2012; Yatagawa et al. 2020, section 3.4).

struct Splat {
    // Factor that gives back the light that softening by k / 2 pixels of the material takes from a sample; linear Rec. 709.
    softening_gain: array<vec4<f32>, 8>,
    // Projection of positions relative to the middle of the scene; column-major, depth 0 to 1.
    clip_from_centre: mat4x4<f32>,
    // Distances in mm where the ring begins and ends to fade in; both 0 for the first.
    fade_in: vec2<f32>,
    // Distances in mm where it begins and ends to fade out; both beyond the radius of scattering for the last.
    fade_out: vec2<f32>,
    // Distance from the light to depth 0 in mm; 0 for a direction.
    middle_mm: f32,
    // Edge of a texel of this level at depth 0, in mm.
    texel_mm: f32,
    // Number of the tile.
    tile: u32,
    // Mipmap level of the samples, and texels to a side of it.
    level: u32,
    side: u32,
    // 0: samples of this level that are smooth; 1: those whose parent in the next level is not.
    refines: u32,
    // Texels of the G-buffer to a side of a texel of the target.
    stride: u32,
    // Pitch of the pixels of the material in mm.
    pitch_mm: f32,
    // Number of the group whose light is spread.
    group: f32,
    // Tiles in a row of the translucent shadow maps.
    columns: u32,
    pad_0: u32,
    pad_1: u32,
}

@group(1) @binding(0) var<uniform> splat_block: Splat;
// Translucent shadow maps with mipmap levels, a square tile for each light, row by row.
@group(1) @binding(1) var tsm_positions: texture_2d<f32>;
@group(1) @binding(2) var tsm_fluxes: texture_2d<f32>;
@group(1) @binding(3) var tsm_uvs: texture_2d<f32>;
// G-buffer: positions relative to the middle of the scene and depth, in mm; texture coordinates of two places on the patch.
@group(1) @binding(4) var positions: texture_2d<f32>;
@group(1) @binding(5) var uvs: texture_2d<f32>;
// Share of the first of two places in the fourth channel.
@group(1) @binding(6) var albedos: texture_2d<f32>;

struct Sample {
    @builtin(position) clip: vec4<f32>,
    @location(0) @interpolate(flat) position: vec3<f32>,
    // Flux in irradiance times mm^2.
    @location(1) @interpolate(flat) flux: vec3<f32>,
    // Pixel of the material, by `pack_pixel`.
    @location(2) @interpolate(flat) pixel: vec4<u32>,
    // Least distance in mm, s.
    @location(3) @interpolate(flat) softening_mm: f32,
}

// Range of depths in a texel, in edges of it, from which on it is not smooth.
const STEEP: f32 = 1.0;
// Softening of samples, in edges of their texels: peaks of the profiles would show where each sample is.
const SOFTENING: f32 = 0.6;

// Factor that gives back the light that distances of sqrt(r^2 + s^2) instead of r take, for s in mm.
fn softening_gain(softening_mm: f32) -> vec3<f32> {
    let at = min(softening_mm / (0.5 * splat_block.pitch_mm), 6.99);
    let k = u32(at);
    return mix(splat_block.softening_gain[min(k, 7u)].xyz, splat_block.softening_gain[min(k + 1u, 7u)].xyz, at - f32(k));
}

// Share of a texel where there is a surface of the group, 0 to 1, by the fourth channel of its flux.
fn share_of(stored: f32, level: u32) -> f32 {
    return select(stored, select(0.0, 1.0, abs(stored - splat_block.group) < 0.5), level == 0u);
}

// Whether a texel is full, and flat along the axis of the light.
fn is_smooth(texel: vec2<u32>, level: u32, texel_mm: f32) -> bool {
    let range = textureLoad(tsm_uvs, texel, level).zw;
    let share = share_of(textureLoad(tsm_fluxes, texel, level).w, level);
    return share > 0.99 && range.y - range.x < STEEP * texel_mm;
}

// Pixel of the patch at texture coordinates, which repeat or are mirrored.
fn patch_texel(uv: vec2<f32>) -> vec2<u32> {
    let size = vec2<i32>(material.size);
    let x = vec2<i32>(floor(uv * vec2<f32>(size)));
    let period = size * select(2, 1, material.addressing == 1u);
    // Made positive first: GLSL's remainder of negative numbers is another one.
    let m = (x + 4 * period) % period;
    if material.addressing == 1u {
        return min(vec2<u32>(m), material.size - 1u);
    }
    // NaN may become any number: clamped once more.
    return min(vec2<u32>(min(m, period - 1 - m)), material.size - 1u);
}

// Lowest and highest place along one axis, -1 to 1, of a sphere that is projected by (row p) / (row_w p) for p relative to its
// centre, where the products are `at` and `w` (Sigg et al. 2006, section 3, from the rows of the matrix). The planes of equal place
// that touch the sphere are those of place = at / w + d with (d w)^2 = r^2 |across - d row_w|^2.
fn projected_bounds(row: vec3<f32>, row_w: vec3<f32>, at: f32, w: f32, radius: f32) -> vec2<f32> {
    let p = w * w - radius * radius * dot(row_w, row_w);
    // A sphere that reaches the plane of the eye may be everywhere.
    if w <= 0.0 || p <= 1e-4 * w * w {
        return vec2<f32>(-1.0, 1.0);
    }
    let across = row - at / w * row_w;
    let q = radius * dot(across, row_w);
    let root = sqrt(q * q + p * dot(across, across));
    return at / w + radius * (vec2<f32>(-root, root) - q) / p;
}

@vertex
fn splat_quad(@builtin(vertex_index) corner: u32, @builtin(instance_index) instance: u32) -> Sample {
    let of_tile = min(vec2<u32>(instance % splat_block.side, instance / splat_block.side), vec2<u32>(splat_block.side - 1u));
    let tile = vec2<u32>(splat_block.tile % splat_block.columns, splat_block.tile / splat_block.columns);
    let texel = of_tile + tile * splat_block.side;
    let flux = textureLoad(tsm_fluxes, texel, splat_block.level);
    let position = textureLoad(tsm_positions, texel, splat_block.level);
    var texel_mm = splat_block.texel_mm;
    if splat_block.middle_mm > 0.0 {
        texel_mm *= 1.0 + position.x / splat_block.middle_mm;
    }
    var wanted = share_of(flux.w, splat_block.level) > 0.0 && max(flux.x, max(flux.y, flux.z)) > 0.0;
    if splat_block.refines != 0u {
        wanted = wanted && !is_smooth(texel / 2u, splat_block.level + 1u, 2.0 * texel_mm);
    } else {
        wanted = wanted && is_smooth(texel, splat_block.level, texel_mm);
    }
    let centre = splat_block.clip_from_centre * vec4<f32>(position.yzw, 1.0);
    let radius = min(splat_block.fade_out.y, material.r_max_mm);
    let rows = transpose(splat_block.clip_from_centre);
    // Nothing behind the eye is seen.
    if !wanted || centre.w < -radius * length(rows[3].xyz) {
        return Sample(vec4<f32>(2.0, 2.0, 2.0, 1.0), vec3<f32>(0.0), vec3<f32>(0.0), vec4<u32>(0u), 0.0);
    }
    let size = textureDimensions(positions);
    // Texels of the target are compared with texels of the G-buffer up to half a texel away.
    let beyond = vec2<f32>(-1.0, 1.0);
    let x = projected_bounds(rows[0].xyz, rows[3].xyz, centre.x, centre.w, radius) + beyond / f32(size.x);
    let y = projected_bounds(rows[1].xyz, rows[3].xyz, centre.y, centre.w, radius) + beyond / f32(size.y);
    // The last column and row of the target may have their middle beyond the G-buffer, of which they show the last texel.
    let last = vec2<f32>(1.0) - 2.0 / vec2<f32>(size);
    let right = select(x.y, 3.0, x.y > last.x);
    let bottom = select(y.x, -3.0, y.x < -last.y);
    let place = vec2<f32>(select(x.x, right, (corner & 1u) == 1u), select(bottom, y.y, (corner >> 1u) == 1u));
    // Texels of the last column and row of the target may reach beyond the G-buffer.
    let stride = splat_block.stride;
    let share = vec2<f32>(size) / vec2<f32>((size + stride - 1u) / stride * stride);
    let clip = vec2<f32>((1.0 + place.x) * share.x - 1.0, 1.0 - (1.0 - place.y) * share.y);
    let uv = textureLoad(tsm_uvs, texel, splat_block.level);
    var light = flux.xyz * texel_mm * texel_mm;
    var softening_mm = 0.0;
    if splat_block.fade_in.y == 0.0 {
        // Samples of a slanted surface are further apart than those across the light.
        let slope = min((uv.w - uv.z) / texel_mm, 2.0);
        softening_mm = SOFTENING * texel_mm * sqrt(1.0 + slope * slope);
        light *= softening_gain(softening_mm);
    }
    return Sample(vec4<f32>(clip, 0.5, 1.0), position.yzw, light, pack_pixel(patch_texel(uv.xy)), softening_mm);
}

// Share of the ring at a distance in mm, 0 to 1.
fn ring_weight(r_mm: f32) -> f32 {
    let begun = select(1.0, smoothstep(splat_block.fade_in.x, splat_block.fade_in.y, r_mm), splat_block.fade_in.y > 0.0);
    return begun * (1.0 - smoothstep(splat_block.fade_out.x, splat_block.fade_out.y, r_mm));
}

@fragment
fn splat(in: Sample) -> @location(0) vec4<f32> {
    let size = textureDimensions(positions);
    let texel = min(vec2<u32>(in.clip.xy) * splat_block.stride + splat_block.stride / 2u, size - 1u);
    let seen = textureLoad(positions, texel, 0);
    let r_mm = distance(seen.xyz, in.position);
    let of_ring = ring_weight(r_mm);
    let softened_mm = sqrt(r_mm * r_mm + in.softening_mm * in.softening_mm);
    // Depth of the background is beyond everything.
    if softened_mm > material.r_max_mm || of_ring <= 0.0 || seen.w > 50000.0 {
        return vec4<f32>(0.0);
    }
    // Rd of the pixels at both points (eq. 2 to 4), r their distance in space.
    let places = textureLoad(uvs, texel, 0);
    var o = partner_at(load_pixel(patch_texel(places.xy)), softened_mm);
    if places.z >= 0.0 {
        o = blended(o, load_pixel(patch_texel(places.zw)), textureLoad(albedos, texel, 0).w);
    }
    let rd = reflectance(unpack_pixel(in.pixel), o, vec2<i32>(0));
    // Within half floats.
    return vec4<f32>(min(rd * in.flux * of_ring, vec3<f32>(60000.0)), 0.0);
}
