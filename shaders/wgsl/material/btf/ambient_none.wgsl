// No light from all around.

fn from_all_around(in: Varying, detail: f32, seen: Seen, tangents: Tangents) -> vec3<f32> {
    return vec3<f32>(0.0);
}
