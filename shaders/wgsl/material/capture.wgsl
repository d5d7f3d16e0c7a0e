// Storage of an uncompressed capture: every entry of every window.

// The array [y][x][dy][dx][rgb] in mm^-2, row by row and layer by layer.
@group(0) @binding(1) var entries: texture_2d_array<f32>;

struct Pixel {
    // Number of the pixel, row by row.
    number: u32,
}

// The pixel at a texel of the patch.
fn load_pixel(texel: vec2<u32>) -> Pixel {
    return Pixel(texel.y * material.size.x + texel.x);
}

// Entry `index` of the array.
fn entry(index: u32) -> f32 {
    let row = index / ROW;
    let rd = textureLoad(entries, vec2<u32>(index % ROW, row % material.rows), row / material.rows, 0).x;
    // Entries that are not positive were not measured; NaN compares false.
    return select(0.0, rd, rd > 0.0);
}

// Share of pixel o in its pairs at a distance: none, the entries are those of the pixel where light enters.
struct Partner {
    r_mm: f32,
}

fn partner_at(o: Pixel, r_mm: f32) -> Partner {
    return Partner(r_mm);
}

// Rd in mm^-2 from pixel i to pixel o; step = x_i - x_o in pixels, so that o lies at -step in the window of i.
fn reflectance(i: Pixel, o: Partner, step: vec2<i32>) -> vec3<f32> {
    let radius = i32(material.window_radius);
    let d = 2u * material.window_radius + 1u;
    let place = vec2<u32>(vec2<i32>(radius) - step);
    let first = 3u * (i.number * d * d + place.y * d + place.x);
    return vec3<f32>(entry(first), entry(first + 1u), entry(first + 2u));
}
