// Exitance and visibility of lights of every vertex, from the points of the reference pass.

// Exitance of every point; linear Rec. 709.
@group(1) @binding(0) var exitances: TargetTexture;
// Visibility of each light from the point, packed.
@group(1) @binding(1) var visibilities: texture_2d<u32>;

// Exitance at a point, by its number.
fn vertex_exitance(point: u32) -> vec3<f32> {
    return unpack(textureLoad(exitances, vec2<u32>(point % scene.row, point / scene.row), 0)).xyz;
}

// Visibility of the lights from a point, by its number.
fn vertex_visibilities(point: u32) -> Visibilities {
    return unpack_visibilities(textureLoad(visibilities, vec2<u32>(point % scene.row, point / scene.row), 0));
}
