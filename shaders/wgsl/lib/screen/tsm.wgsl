// Translucent shadow map (Dachsbacher and Stamminger 2003): what the passes that draw it write, and the number of its light.

struct TsmTexel {
    // Mean of positions relative to the middle of the scene, and of depth along the light's axis, in mm.
    @location(0) position: TargetTexel,
    // Mean irradiance that enters, on a plane across the axis; at the finest level the number of the group that it enters, 0
    // where there is no surface; at the coarser ones the share of the texel where there is a surface of one group.
    @location(1) flux: TargetTexel,
    // Texture coordinates on the patch of one of the points; lowest and highest depth of all, in mm.
    @location(2) uv: TargetTexel,
}

struct TsmLight {
    // Number of the light, 0 to 3.
    light: u32,
    // Number of the group whose light the coarser levels have.
    group: f32,
    // Level that is made from the one before, from 1 on; 0 for the finest.
    level: u32,
    pad: u32,
}
