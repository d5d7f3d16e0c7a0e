// Base scattering profiles (Yatagawa et al. 2020, eq. 3).

// S x M, log-scale: node across, material down, rgb in a texel. Where there are more than base_rows materials, the next
// ones stand beside the first.
@group(0) @binding(1) var profiles: texture_2d<f32>;

// Texel of node 0 of a base material; an index too large names the last one.
fn base_texel(index: u32) -> vec2<u32> {
    let base = min(index, material.base_materials - 1u);
    return vec2<u32>(base / material.base_rows * material.samples, base % material.base_rows);
}

fn base_node(base: vec2<u32>, h: u32) -> vec3<f32> {
    return textureLoad(profiles, base + vec2<u32>(h, 0u), 0).xyz;
}

fn base_profile(base: vec2<u32>, knot: Knot) -> vec3<f32> {
    return mix(base_node(base, knot.h), base_node(base, knot.h + 1u), knot.w);
}
