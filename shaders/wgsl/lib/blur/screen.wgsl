// Screen that blurs work on: how large things are on its texels.

struct ScreenDomain {
    // Texels of the maps.
    size: vec2<u32>,
    // Texels that the pitch of the material covers at a distance of 1 mm, or at any, along rows and columns.
    focal_texels: vec2<f32>,
    // Distance from the eye to depth 0, in mm; 1 where the projection is parallel.
    middle_mm: f32,
    // Pitch of the pixels of the material in mm.
    pitch_mm: f32,
    // 1 in perspective, where things further away are smaller; 0 where the projection is parallel.
    perspective: f32,
    // 1 if a third of the taps of a separable kernel are turned, by an angle of each texel's own; not looked at by cascades.
    is_jittered: u32,
}

@group(0) @binding(1) var<uniform> domain: ScreenDomain;

// Depth of the background is beyond everything.
const BACKGROUND_MM: f32 = 50000.0;
