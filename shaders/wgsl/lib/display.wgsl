// The target takes display values.
fn encoded(light: vec3<f32>) -> vec3<f32> {
    return srgb(light);
}
