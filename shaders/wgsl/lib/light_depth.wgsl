// Depth along a light's axis, from the middle of the scene, in mm.
fn light_depth(i: u32, position_mm: vec3<f32>) -> f32 {
    return dot(position_mm - scene.centre_mm, scene.light[min(i, 3u)].axis);
}
