// Exitance of every vertex from its transfer: a look-up in the table of its cluster, and a product for each component.

struct Transfer {
    // Bits and mask of the coefficient of each component.
    codes: array<vec4<u32>, 16>,
    // Number of components, 1 to 16.
    components: u32,
    // Texels of a vertex, 1 or 2.
    texels: u32,
    pad_0: u32,
    pad_1: u32,
}

@group(1) @binding(0) var<uniform> transfer: Transfer;
// Cluster and coefficients of every vertex as they stand in the file, 16 bits to a channel: some drivers lose the upper half of 32.
@group(1) @binding(1) var vertex_codes: texture_2d<u32>;
// Exitance of the clusters under all lights together, a row each: a constant, then what a step of each coefficient adds; linear Rec. 709.
@group(1) @binding(2) var light_table: texture_2d<f32>;

// Texel of the codes, by its number.
fn code_texel(number: u32) -> vec4<u32> {
    let texel = min(array_texel(number), textureDimensions(vertex_codes) - 1u);
    return textureLoad(vertex_codes, texel, 0);
}

// Entry of the table of a cluster.
fn table_entry(entry: u32, cluster: u32) -> vec3<f32> {
    return textureLoad(light_table, min(vec2<u32>(entry, cluster), textureDimensions(light_table) - 1u), 0).xyz;
}

// Exitance at a vertex, by its number.
fn vertex_exitance(vertex: u32, point: u32, shares: vec3<f32>) -> vec3<f32> {
    // Two rows of 16-bit words that move down together, so that the next code is always in the first.
    var low = code_texel(vertex * transfer.texels);
    var high = vec4<u32>(0u);
    if transfer.texels > 1u {
        high = code_texel(vertex * transfer.texels + 1u);
    }
    let cluster = low.x & 255u;
    var sum = table_entry(0u, cluster);
    var used = vec4<u32>(8u);
    for (var k = 0u; k < min(transfer.components, 16u); k++) {
        low = ((low >> used) | (vec4<u32>(low.yzw, high.x) << (16u - used))) & vec4<u32>(65535u);
        high = ((high >> used) | (vec4<u32>(high.yzw, 0u) << (16u - used))) & vec4<u32>(65535u);
        let code = transfer.codes[k];
        sum += table_entry(k + 1u, cluster) * f32(low.x & code.y);
        used = vec4<u32>(code.x);
    }
    return max(sum, vec3<f32>(0.0));
}

fn vertex_visibilities(point: u32) -> Visibilities {
    return Visibilities(vec4<f32>(0.0), vec4<f32>(0.0));
}
