// Lights, environment and camera of a scene.

const MAX_LIGHTS: u32 = 8u;
// It shines through everything.
const NO_SHADOW: u32 = 0u;
// A tile of the translucent shadow maps.
const OWN_SHADOW: u32 = 1u;
// A depth map of the host's, whose depth rises away from the light, or falls.
const HOST_SHADOW: u32 = 2u;
const HOST_SHADOW_REVERSED: u32 = 3u;

struct LightSource {
    // Projection of the light's own view, or of the host's map; column-major, depth 0 to 1.
    clip_from_world: mat4x4<f32>,
    // Unit vector towards the light, or its position in mm.
    position_or_direction: vec3<f32>,
    // 0 for a direction, 1 for a position.
    is_local: u32,
    // Irradiance on a plane that faces the light: of a direction anywhere, of a position 1 mm away; linear Rec. 709.
    irradiance: vec3<f32>,
    // Cosine of the angle from the axis beyond which there is no light, and where it begins to fade.
    cos_outer: f32,
    // Unit vector along which the light looks.
    axis: vec3<f32>,
    cos_inner: f32,
    // Distance along the axis from the light to depth 0; 0 for a direction.
    middle_mm: f32,
    // Edge of a texel of its translucent shadow map at depth 0, in mm.
    texel_mm: f32,
    // How it is known where the light does not reach: NO_SHADOW, OWN_SHADOW, HOST_SHADOW or HOST_SHADOW_REVERSED.
    shadow: u32,
    // Number of the tile of the translucent shadow maps, or of the host's map.
    map: u32,
}

struct Scene {
    // Projection of the camera; column-major, depth 0 to 1.
    clip_from_world: mat4x4<f32>,
    // Position of the eye in mm; very far away where the projection is parallel.
    eye_mm: vec3<f32>,
    // Multiplies radiance before tone mapping.
    exposure: f32,
    // Unit vector along which the eye looks.
    forward: vec3<f32>,
    // Number of lights.
    lights: u32,
    // Middle of the scene in mm: depth is 0 there, and half-float positions are finest.
    centre_mm: vec3<f32>,
    // Texels to a side of a tile of the translucent shadow maps, and tiles in a row of them, at least 1.
    light_texels: u32,
    light_columns: u32,
    pad_0: u32,
    pad_1: u32,
    // Irradiance of the environment on a normal (x, y, z): coefficients of 1, y, z, x, xy, yz, 3 z^2 - 1, xz, x^2 - y^2.
    sky: array<vec4<f32>, 9>,
    light: array<LightSource, MAX_LIGHTS>,
}

@group(0) @binding(0) var<uniform> scene: Scene;

// Bound of what is drawn to half floats: beyond 65504 they are infinite, and infinity times 0 is NaN.
const BRIGHTEST: vec3<f32> = vec3<f32>(60000.0);

// Light of one source at a point.
struct Incident {
    // Unit vector towards the source.
    towards: vec3<f32>,
    // Irradiance on a plane that faces the source; linear Rec. 709.
    irradiance: vec3<f32>,
}

// Light of source `i` at a position in mm, without occlusion.
fn incident(i: u32, position_mm: vec3<f32>) -> Incident {
    let source = scene.light[min(i, MAX_LIGHTS - 1u)];
    if source.is_local == 0u {
        return Incident(source.position_or_direction, source.irradiance);
    }
    let to_light = source.position_or_direction - position_mm;
    let distance2 = max(dot(to_light, to_light), 1e-6);
    let towards = to_light * inverseSqrt(distance2);
    // Full inside the inner cone, none outside the outer one.
    let cone = smoothstep(source.cos_outer, source.cos_inner, -dot(towards, source.axis));
    return Incident(towards, source.irradiance * cone / distance2);
}

// Depth of a position along the axis of light `i`, from the middle of the scene, in mm.
fn light_depth(i: u32, position_mm: vec3<f32>) -> f32 {
    return dot(position_mm - scene.centre_mm, scene.light[min(i, MAX_LIGHTS - 1u)].axis);
}

// Texel of a tile of the translucent shadow maps, not rounded, and the edge of a texel at that depth in mm.
struct TsmCoord {
    texel: vec2<f32>,
    texel_mm: f32,
}

// Texel of the tile of light i that shows a position in mm.
fn tsm_coord(i: u32, position_mm: vec3<f32>) -> TsmCoord {
    let source = scene.light[min(i, MAX_LIGHTS - 1u)];
    let clip = source.clip_from_world * vec4<f32>(position_mm, 1.0);
    let texel = (clip.xy / clip.w * vec2<f32>(0.5, -0.5) + 0.5) * f32(scene.light_texels);
    var grown = 1.0;
    if source.is_local != 0u {
        grown = 1.0 + light_depth(i, position_mm) / source.middle_mm;
    }
    return TsmCoord(texel, source.texel_mm * grown);
}

// A texel of the tile of light i, clamped to it, among all tiles.
fn tsm_texel(i: u32, texel: vec2<i32>) -> vec2<i32> {
    let side = i32(scene.light_texels);
    let number = scene.light[min(i, MAX_LIGHTS - 1u)].map;
    let tile = vec2<i32>(i32(number % scene.light_columns), i32(number / scene.light_columns));
    return clamp(texel, vec2<i32>(0), vec2<i32>(side - 1)) + tile * side;
}
