// Visibilities of all lights from one point, 0 to 1.

struct Visibilities {
    // Of the first four lights.
    first: vec4<f32>,
    // Of the others.
    last: vec4<f32>,
}

// From 16 bits for every two lights, the lower byte for the first of them: some drivers lose the upper half of 32.
fn unpack_visibilities(packed: vec4<u32>) -> Visibilities {
    let low = vec4<f32>(packed & vec4<u32>(255u)) / 255.0;
    let high = vec4<f32>(packed >> vec4<u32>(8u)) / 255.0;
    return Visibilities(vec4<f32>(low.x, high.x, low.y, high.y), vec4<f32>(low.z, high.z, low.w, high.w));
}

// Of light `i`.
fn visibility_of(i: u32, all: Visibilities) -> f32 {
    // Only variables can be indexed by what is not constant.
    var four = all.first;
    if i >= 4u {
        four = all.last;
    }
    return four[i & 3u];
}
