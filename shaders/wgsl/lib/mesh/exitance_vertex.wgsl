// Exitance that was gathered at every vertex.

// Of every point; linear rgb.
@group(1) @binding(0) var exitances: KeptImage;
// How much of each light reaches the point.
@group(1) @binding(1) var visibilities: texture_2d<f32>;

fn vertex_exitance(point: u32) -> vec3<f32> {
    return told(textureLoad(exitances, vec2<u32>(point % scene.row, point / scene.row), 0)).xyz;
}

fn vertex_visibility(point: u32) -> vec4<f32> {
    return textureLoad(visibilities, vec2<u32>(point % scene.row, point / scene.row), 0);
}

fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    return in.exitance;
}

fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    var seen = in.visibility;
    return seen[min(i, 3u)];
}
