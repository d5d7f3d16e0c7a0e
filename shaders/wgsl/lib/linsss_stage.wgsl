// One Gaussian on the screen, or a level of the pyramid: how large it is where a texel lies.

struct LinsssStage {
    // sigma_h by channel, in mm.
    sigma_mm: vec4<f32>,
    // (1, 0) or (0, 1).
    axis: vec2<i32>,
    // Texels of the maps that hold anything, columns and rows.
    size: vec2<i32>,
    // Texels of the maps that 1 mm covers at a distance of 1 mm, or at any, along rows and columns.
    focal_texels: vec2<f32>,
    // Distance from the eye to depth 0 in mm; 1 where the projection is parallel.
    middle_mm: f32,
    // 1 in perspective, where things further away are smaller; 0 where the projection is parallel.
    perspective: f32,
    // Levels of the pyramid, and the one that is drawn.
    levels: u32,
    level: u32,
    // Texels of the maps, of which the first hold something, columns and rows.
    most: vec2<i32>,
}

@group(0) @binding(0) var<uniform> stage: LinsssStage;

// Depth of the background is beyond everything.
const BACKGROUND_MM: f32 = 50000.0;

// Texels that 1 mm covers at a depth in mm, along rows and columns.
fn texels_per_mm(depth: f32) -> vec2<f32> {
    return stage.focal_texels / max(stage.middle_mm + stage.perspective * depth, 1e-3);
}

// Factor of exp(-r^2 / 2 sigma^2) for a difference of depth, by channel.
fn nearness_of(apart_mm: f32, sigma_mm: vec3<f32>) -> vec3<f32> {
    let d = vec3<f32>(apart_mm) / sigma_mm;
    return exp(-0.5 * min(d * d, vec3<f32>(80.0)));
}

// Variance with which a level of the pyramid shows the light, in texels of the finest; 1/6 of a texel of its own for interpolation.
fn variance_of(level: u32) -> f32 {
    if level < 3u {
        return 0.25 * f32(level * level);
    }
    let side = f32(1u << (level - 2u));
    return side * side * 7.0 / 6.0;
}

// Last texel of a level that holds anything. Levels 0, 1 and 2 are of the same size.
fn last_of(level: u32) -> vec2<i32> {
    let halvings = vec2<u32>(max(level, 2u) - 2u);
    // A half texel at the end has none of its own where the map ends.
    return min((stage.size - 1) >> halvings, max(stage.most >> halvings, vec2<i32>(1)) - 1);
}
