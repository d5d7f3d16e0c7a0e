// Needs: <target format>, <fitted material layout>, array, fullscreen.
// Reference pass on a surface: exitance(x_o) = sum over points x_i of Rd(x_i, x_o) E(x_i) dA, r their distance in space.
// Points are spread over the surface and sorted into the cells of a grid; all tables are arrays in textures.

struct PointGrid {
    // Lowest corner of the grid in mm, and the edge of a cell.
    origin_mm: vec3<f32>,
    cell_mm: f32,
    // Cells in x, y and z.
    cells: vec3<u32>,
    // Number of points.
    points: u32,
}

@group(1) @binding(0) var<uniform> grid: PointGrid;
// Positions in mm, and the area in mm^2 that each point stands for.
@group(1) @binding(1) var positions: texture_2d<f32>;
// First point of every cell, [z][y][x], and one more entry: the number of points.
@group(1) @binding(2) var cell_starts: texture_2d<u32>;
// Pixel of the material at each point.
@group(1) @binding(3) var pixels: texture_2d<u32>;
// Irradiance that has entered at each point; linear Rec. 709.
@group(1) @binding(4) var irradiances: TargetTexture;

// Rows of cells that are a little too far away are looked at, too: positions are rounded.
const REACH: f32 = 1.001;

// Cell of a position in mm, clamped to the grid.
fn cell_of(position_mm: vec3<f32>) -> vec3<u32> {
    let cell = floor((position_mm - grid.origin_mm) / grid.cell_mm);
    return vec3<u32>(clamp(cell, vec3<f32>(0.0), vec3<f32>(grid.cells - 1u)));
}

// Point whose exitance a texel holds. Points that follow each other are neighbours: they share tiles of 8 x 8 texels, so that what
// a processor draws side by side looks at the same cells.
fn point_at(texel: vec2<u32>) -> u32 {
    let tile = texel / 8u;
    let within = texel % 8u;
    return (tile.y * (ROW / 8u) + tile.x) * 64u + within.y * 8u + within.x;
}

// First point of a cell.
fn cell_start(cell: u32) -> u32 {
    return min(textureLoad(cell_starts, array_texel(cell), 0).x, grid.points);
}

@fragment
fn surface_gather(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    let point = point_at(vec2<u32>(at.xy));
    // The last tiles are not full.
    if point >= grid.points {
        return pack(vec4<f32>(0.0));
    }
    let texel = array_texel(point);
    let x_o = textureLoad(positions, texel, 0).xyz;
    let o = load_pixel(min(textureLoad(pixels, texel, 0).xy, material.size - 1u));
    let reach = REACH * material.r_max_mm;
    let low = cell_of(x_o - reach);
    let high = cell_of(x_o + reach);
    var sum = vec3<f32>(0.0);
    for (var z = low.z; z <= high.z; z++) {
        for (var y = low.y; y <= high.y; y++) {
            // A row of cells along x begins somewhere in y and z: how far along x it is within reach.
            let begin = grid.origin_mm.yz + vec2<f32>(vec2<u32>(y, z)) * grid.cell_mm;
            let away = max(max(begin - x_o.yz, x_o.yz - begin - grid.cell_mm), vec2<f32>(0.0));
            let rest = reach * reach - dot(away, away);
            if rest < 0.0 {
                continue;
            }
            let along = vec3<f32>(sqrt(rest), 0.0, 0.0);
            // The cells of a row follow each other, and so do their points.
            let row = (z * grid.cells.y + y) * grid.cells.x;
            let end = cell_start(row + cell_of(x_o + along).x + 1u);
            for (var i = cell_start(row + cell_of(x_o - along).x); i < end; i++) {
                let texel_i = array_texel(i);
                let x_i = textureLoad(positions, texel_i, 0);
                let r_mm = distance(x_i.xyz, x_o);
                if r_mm > material.r_max_mm {
                    continue;
                }
                // Half of a closed surface is turned away from a light: nothing enters there.
                let e = unpack(textureLoad(irradiances, texel_i, 0)).xyz;
                if all(e == vec3<f32>(0.0)) {
                    continue;
                }
                let pixel = min(textureLoad(pixels, texel_i, 0).xy, material.size - 1u);
                let partner = partner_at(o, r_mm);
                sum += reflectance(load_pixel(pixel), partner, vec2<i32>(0)) * e * x_i.w;
            }
        }
    }
    return pack(vec4<f32>(sum, 1.0));
}
