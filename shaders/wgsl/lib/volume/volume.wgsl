// Light volume: cells in space around the objects of a group, in which wide Gaussians spread the light that enters.

struct Volume {
    // Projections of the lights' own views, inverted; column-major, depth 0 to 1.
    world_from_clip: array<mat4x4<f32>, 8>,
    // Middle of the first cell in mm.
    origin_mm: vec3<f32>,
    // Edge of a cell in mm.
    cell_mm: f32,
    // Number of cells along x, y and z.
    cells: vec3<i32>,
    // Slices of equal z that lie in a row of the texture.
    columns: i32,
    // Number of the first Gaussian that spreads in the volume, as many as there are if none does.
    first: u32,
    // Number of the group whose light it is.
    group: f32,
    // Pitch of the pixels of the material in mm.
    pitch_mm: f32,
    pad: u32,
}

// Texel of a cell.
fn texel_of(cell: vec3<i32>) -> vec2<i32> {
    return cell.xy + vec2<i32>(cell.z % volume.columns, cell.z / volume.columns) * volume.cells.xy;
}

// Place of a position in mm, in cells from the middle of the first.
fn place_in_volume(position_mm: vec3<f32>) -> vec3<f32> {
    return (position_mm - volume.origin_mm) / volume.cell_mm;
}

// Quadratic B-spline of the distance from the middle of a cell along each axis, in cells: it spreads light by a variance of a quarter,
// wherever that lies. Nearest cells and linear interpolation would move it, or spread it by more between cells.
fn spline(distance: vec3<f32>) -> vec3<f32> {
    let d = abs(distance);
    let beyond = max(1.5 - d, vec3<f32>(0.0));
    return select(0.5 * beyond * beyond, 0.75 - d * d, d < vec3<f32>(0.5));
}

// Cell of a texel; beyond the last slice there is none.
fn cell_at(texel: vec2<i32>) -> vec3<i32> {
    let tile = texel / volume.cells.xy;
    // Beyond the last column lies nothing.
    let slice = select(volume.cells.z, tile.y * volume.columns + tile.x, tile.x < volume.columns);
    return vec3<i32>(texel - tile * volume.cells.xy, slice);
}
