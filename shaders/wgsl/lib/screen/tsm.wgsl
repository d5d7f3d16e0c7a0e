// Translucent shadow maps (Dachsbacher and Stamminger 2003), a square tile for each light, row by row: what the passes that
// draw them write.

struct TsmTexel {
    // Mean of depths along the light's axis, and of positions relative to the middle of the scene, in mm, by the light that enters; those of
    // one of the points where they lie far apart. Targets of one channel keep the depth.
    @location(0) position: TargetTexel,
    // Mean irradiance that enters, on a plane across the axis; at the finest level the number of the group that it enters, 0
    // where there is no surface; at the coarser ones the share of the texel where there is a surface of one group.
    @location(1) flux: TargetTexel,
    // Texture coordinates on the patch of one of the points; lowest and highest depth of all, in mm. Targets of two channels
    // keep the coordinates.
    @location(2) uv: TargetTexel,
}

struct TsmLight {
    // Number of the light whose tile is drawn.
    light: u32,
    // Number of the group whose light the coarser levels have.
    group: f32,
    // Level that is made from the one before, from 1 on; 0 for the finest.
    level: u32,
    pad: u32,
}
