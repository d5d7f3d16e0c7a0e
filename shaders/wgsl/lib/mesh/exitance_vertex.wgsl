// Exitance and visibility of lights of every vertex, from the points of the reference pass.

// Exitance of every point; linear Rec. 709.
@group(1) @binding(0) var exitances: TargetTexture;
// Visibility of each light from the point, packed.
@group(1) @binding(1) var visibilities: texture_2d<u32>;

// Exitance at a point, by its number.
fn point_exitance(point: u32) -> vec3<f32> {
    // Points that follow each other share tiles of 8 x 8 texels.
    let tiles = ROW / 8u;
    let tile = vec2<u32>(point / 64u % tiles, point / 64u / tiles);
    let texel = min(8u * tile + vec2<u32>(point % 8u, point / 8u % 8u), textureDimensions(exitances) - 1u);
    return unpack(textureLoad(exitances, texel, 0)).xyz;
}

// Exitance at a vertex: of its point, or of two that follow each other where box mapping blends two places.
fn vertex_exitance(vertex: u32, point: u32, shares: vec3<f32>) -> vec3<f32> {
    let share = box_sides(shares).share;
    if object.is_boxed == 0u || share == 1.0 {
        return point_exitance(point);
    }
    return mix(point_exitance(point + 1u), point_exitance(point), share);
}

// Visibility of the lights from a point, by its number.
fn vertex_visibilities(point: u32) -> Visibilities {
    return unpack_visibilities(textureLoad(visibilities, array_texel(point), 0));
}
