// No light of the environment on BTFs.

fn ambient_light(in: Varying, lod: f32, eye: ViewCoord, tangents: Tangents) -> vec3<f32> {
    return vec3<f32>(0.0);
}
