// Exitance and visibility of lights of every vertex, from the points of the reference pass.

// Exitance of every point; linear Rec. 709.
@group(1) @binding(0) var exitances: TargetTexture;
// Visibility of each light from the point, 0 to 1.
@group(1) @binding(1) var visibilities: texture_2d<f32>;

// Exitance at a point, by its number.
fn vertex_exitance(point: u32) -> vec3<f32> {
    return unpack(textureLoad(exitances, vec2<u32>(point % scene.row, point / scene.row), 0)).xyz;
}

// Visibility of the four lights from a point, by its number.
fn vertex_visibility(point: u32) -> vec4<f32> {
    return textureLoad(visibilities, vec2<u32>(point % scene.row, point / scene.row), 0);
}
