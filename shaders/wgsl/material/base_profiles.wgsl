// Log-scale base scattering profiles (Yatagawa et al. 2020, eq. 3).

// S x M texels: node across, base material down; natural log of P in mm^-2, linear Rec. 709. Where there are more than BASE_ROWS
// materials, the next ones stand beside the first.
@group(0) @binding(1) var profiles: texture_2d<f32>;

// Base materials to a column of the texture.
const BASE_ROWS: u32 = 1024u;

// Texel of node 0 of a base material; an index too large names the last one.
fn base_texel(index: u32) -> vec2<u32> {
    let base = min(index, material.base_materials - 1u);
    return vec2<u32>(base / BASE_ROWS * material.samples, base % BASE_ROWS);
}

// Node h of a profile that begins at a texel.
fn base_node(base: vec2<u32>, h: u32) -> vec3<f32> {
    return textureLoad(profiles, base + vec2<u32>(h, 0u), 0).xyz;
}

// A profile between two nodes.
fn base_profile(base: vec2<u32>, knot: Knot) -> vec3<f32> {
    return mix(base_node(base, knot.h), base_node(base, knot.h + 1u), knot.w);
}
