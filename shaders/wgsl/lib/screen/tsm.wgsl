// What a light sees, and which light.

struct Seen {
    // Mean of positions relative to the middle of the scene, and of depth along the light's axis, in mm.
    @location(0) position: Kept,
    // Mean irradiance that enters, on a plane across the axis, and the share of the texel where there is a surface.
    @location(1) flux: Kept,
    // Place on the patch of one of the points seen; lowest and highest depth of all.
    @location(2) place: Kept,
}

struct Which {
    // Number of the light.
    light: u32,
    pad_0: u32,
    pad_1: u32,
    pad_2: u32,
}
