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
    pad: u32,
}

@group(0) @binding(1) var<uniform> domain: ScreenDomain;
