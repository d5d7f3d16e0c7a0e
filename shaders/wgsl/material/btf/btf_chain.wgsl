// Apparent BRDFs of nested codebooks, by chained look-ups (Havran et al. 2010, eq. 4), linear between the nodes of all four axes.

// The four nodes of view around a direction, shape [phi][theta].
struct Corners {
    // Rows of M, or of P2 in later stages.
    rows: vec4<u32>,
    // Exponents of the scales c_P6 c_P4 c_P3, in 1/64 octaves.
    exponents: vec4<i32>,
    // Interpolation weights, of sum 1, times the signs of c_P6 c_P4 c_P3.
    weights: vec4<f32>,
}

// Scale of an exponent in 1/64 octaves: 2^(exponent / 64).
fn scale_of(exponent: i32) -> f32 {
    let octave = bitcast<f32>(u32(clamp((exponent >> 6u) + 127, 1, 254)) << 23u);
    return exp2(f32(exponent & 63) / 64.0) * octave;
}

// Exponent of the code of a scale, in 1/64 octaves.
fn exponent_of(table: BtfTable, code: u32) -> i32 {
    return table.offset + i32((code & table.code_mask) << table.step);
}

// Sign of the code of a scale, 1 or -1.
fn sign_of(table: BtfTable, code: u32) -> f32 {
    return 1.0 - 2.0 * f32((code >> table.sign_at) & table.sign_mask);
}

// Nodes of view of row `p4` of P4, times c_P6 of an exponent and a sign.
fn corners_of(stage: u32, p4: u32, exponent: i32, sign: f32, eye: ViewCoord) -> Corners {
    let of_p4 = codebooks.chains[4u * stage + 1u];
    let of_p3 = codebooks.chains[4u * stage + 2u];
    var corners: Corners;
    for (var k = 0u; k < 2u; k++) {
        // Row of P3 at phi_v of P4; node n_phi is node 0.
        let node = eye.phi.first + k;
        let item = bits_at(item_at(of_p4, p4, select(node, 0u, node == codebooks.nodes.w)));
        let code = item >> of_p4.index_bits;
        let so_far = exponent + exponent_of(of_p4, code);
        let weight = select(1.0 - eye.phi.weight, eye.phi.weight, k == 1u) * sign * sign_of(of_p4, code);
        // Rows at theta_v and the next node.
        let items = two_at(item_at(of_p3, index_of(of_p4, item), eye.theta.first), of_p3.width);
        let codes = items >> vec2<u32>(of_p3.index_bits);
        let rows = vec2<u32>(index_of(of_p3, items.x), index_of(of_p3, items.y));
        let exponents = so_far + vec2<i32>(exponent_of(of_p3, codes.x), exponent_of(of_p3, codes.y));
        let signs = vec2<f32>(sign_of(of_p3, codes.x), sign_of(of_p3, codes.y));
        let weights = weight * signs * vec2<f32>(1.0 - eye.theta.weight, eye.theta.weight);
        if k == 0u {
            corners = Corners(vec4<u32>(rows, rows), vec4<i32>(exponents, exponents), vec4<f32>(weights, weights));
        } else {
            corners.rows = vec4<u32>(corners.rows.xy, rows);
            corners.exponents = vec4<i32>(corners.exponents.xy, exponents);
            corners.weights = vec4<f32>(corners.weights.xy, weights);
        }
    }
    return corners;
}

// Items of P2 at a node of alpha and the next: rows of P1 and codes of scales.
struct Slices {
    rows: vec2<u32>,
    codes: vec2<u32>,
}

// Items of row `p2` of P2 at a node of alpha and the next.
fn slices_of(stage: u32, p2: u32, node: u32) -> Slices {
    let table = codebooks.chains[4u * stage + 3u];
    let items = two_at(item_at(table, p2, node), table.width);
    let bytes = bits_at(codebooks.p2_bytes[stage] + 8u * (p2 * codebooks.nodes.x + node));
    // The lowest eight bits stand apart; bits above those of the code are masked off later.
    let codes = (vec2<u32>(bytes, bytes >> 8u) & vec2<u32>(255u)) | ((items >> vec2<u32>(table.index_bits)) << vec2<u32>(8u));
    return Slices(vec2<u32>(index_of(table, items.x), index_of(table, items.y)), codes);
}

// First bit of a row of P1.
fn slice_at(stage: u32, row: u32) -> u32 {
    return codebooks.p1[stage] + 8u * row * (codebooks.nodes.y + 1u);
}

// Values of a slice that begins at a bit, at a node of beta and the next, in steps of a code.
fn slice_values(stage: u32, bit: u32, node: u32) -> vec2<f32> {
    let bytes = bits_at(bit + 8u * node);
    if codebooks.is_signed[stage] == 1u {
        return vec2<f32>(f32(i32(bytes << 24u) >> 24u), f32(i32(bytes << 16u) >> 24u));
    }
    return vec2<f32>(f32(bytes & 255u), f32((bytes >> 8u) & 255u));
}

// Exponent of a slice in 1/64 octaves; the byte at its end is in 1/32 octaves.
fn slice_exponent(bit: u32) -> i32 {
    return 2 * i32(byte_at(bit + 8u * codebooks.nodes.y));
}

// Luma of the four nodes of light, [alpha][beta], in steps of a code, times all weights.
fn lumas_of(stage: u32, p2: u32, exponent: i32, weight: f32, lit: LightCoord) -> vec4<f32> {
    let table = codebooks.chains[4u * stage + 3u];
    let slices = slices_of(stage, p2, lit.alpha.first);
    let weights = vec2<f32>(1.0 - lit.beta.weight, lit.beta.weight);
    let low = slice_at(stage, slices.rows.x);
    let high = slice_at(stage, slices.rows.y);
    let c_low = scale_of(exponent + exponent_of(table, slices.codes.x) + slice_exponent(low));
    let c_high = scale_of(exponent + exponent_of(table, slices.codes.y) + slice_exponent(high));
    let of_low = weight * (1.0 - lit.alpha.weight) * sign_of(table, slices.codes.x) * c_low;
    let of_high = weight * lit.alpha.weight * sign_of(table, slices.codes.y) * c_high;
    return vec4<f32>(
        of_low * weights * slice_values(stage, low, lit.beta.first),
        of_high * weights * slice_values(stage, high, lit.beta.first),
    );
}

// Sum of four values.
fn total(values: vec4<f32>) -> f32 {
    return (values.x + values.y) + (values.z + values.w);
}

// Rows of P2 and of I2 of a row of M.
fn merged_row(row: u32) -> vec2<u32> {
    let bits = bits_at(item_at(codebooks.merged, row, 0u));
    return vec2<u32>(index_of(codebooks.merged, bits), min((bits >> codebooks.merged.index_bits) & codebooks.i2_mask, codebooks.last_i2));
}

// Codes of the chroma channels a and b at a bit.
fn chroma_codes(bit: u32) -> vec2<f32> {
    let codes = bits_at(bit);
    return vec2<f32>(f32(codes & 255u), f32((codes >> 8u) & 255u));
}

// Codes of the chroma of an entry of C.
fn colour_codes(entry: u32) -> vec2<f32> {
    return chroma_codes(codebooks.colours + 16u * entry);
}

// Sum of the codes of chroma of a row of I2 at the four nodes of light, each times its share.
fn chroma_of(i2: u32, shares: vec4<f32>, lit: LightCoord) -> vec2<f32> {
    let rows = two_at(item_at(codebooks.i2, i2, lit.alpha.first), codebooks.i2.width);
    let low = two_at(item_at(codebooks.i1, index_of(codebooks.i2, rows.x), lit.beta.first), codebooks.i1.width);
    let high = two_at(item_at(codebooks.i1, index_of(codebooks.i2, rows.y), lit.beta.first), codebooks.i1.width);
    return shares.x * colour_codes(index_of(codebooks.i1, low.x)) + shares.y * colour_codes(index_of(codebooks.i1, low.y))
        + shares.z * colour_codes(index_of(codebooks.i1, high.x)) + shares.w * colour_codes(index_of(codebooks.i1, high.y));
}

// Luma of a stage after the first.
fn later_luma(stage: u32, texel: u32, eye: ViewCoord, lit: LightCoord) -> f32 {
    let of_p6 = codebooks.chains[4u * stage];
    let item = bits_at(item_at(of_p6, texel, 0u));
    let code = item >> of_p6.index_bits;
    var corners = corners_of(stage, index_of(of_p6, item), exponent_of(of_p6, code), sign_of(of_p6, code), eye);
    var sum = 0.0;
    for (var k = 0u; k < 4u; k++) {
        sum += total(lumas_of(stage, corners.rows[k], corners.exponents[k], corners.weights[k], lit));
    }
    return sum / select(255.0, 127.0, codebooks.is_signed[stage] == 1u);
}

// Apparent BRDF of a texel from a view: the first stage, as far as it does not depend on the light.
struct ApparentBrdf {
    texel: u32,
    // Rows of P2 and of I2 at the four nodes of view.
    rows: vec4<u32>,
    chroma: vec4<u32>,
    // Exponents of c_P4 c_P3 there, and of c_P6, in 1/64 octaves.
    exponents: vec4<i32>,
    of_texel: i32,
    // Interpolation weights times signs.
    weights: vec4<f32>,
    // Chroma of the texel, in steps of a code.
    tint: vec2<f32>,
}

fn apparent_brdf(texel: u32, eye: ViewCoord) -> ApparentBrdf {
    let of_p6 = codebooks.chains[0];
    let item = bits_at(item_at(of_p6, texel, 0u));
    var corners = corners_of(0u, index_of(of_p6, item), 0, 1.0, eye);
    var rows: vec4<u32>;
    var chroma: vec4<u32>;
    for (var k = 0u; k < 4u; k++) {
        let merged = merged_row(corners.rows[k]);
        rows[k] = merged.x;
        chroma[k] = merged.y;
    }
    var tint = vec2<f32>(0.0);
    if codebooks.tint_count > 0u {
        let number = (item & mask_of(of_p6.width)) >> codebooks.tint_at;
        tint = chroma_codes(codebooks.tints + 16u * min(number, codebooks.tint_count - 1u)) - 128.0;
    }
    let of_texel = exponent_of(of_p6, item >> of_p6.index_bits);
    return ApparentBrdf(texel, rows, chroma, corners.exponents, of_texel, corners.weights, tint);
}

// Luma and chroma for a light, without the fade of low lights.
fn luma_chroma(brdf: ApparentBrdf, eye: ViewCoord, lit: LightCoord) -> vec3<f32> {
    var copy = brdf;
    let betas = vec2<f32>(1.0 - lit.beta.weight, lit.beta.weight);
    let light_weights = vec4<f32>((1.0 - lit.alpha.weight) * betas, lit.alpha.weight * betas);
    let is_one_chroma = all(brdf.chroma == brdf.chroma.xxxx);
    var lumas = vec4<f32>(0.0);
    var chroma = vec2<f32>(0.0);
    for (var k = 0u; k < 4u; k++) {
        let of_corner = lumas_of(0u, copy.rows[k], brdf.of_texel + copy.exponents[k], copy.weights[k], lit);
        lumas += of_corner;
        if !is_one_chroma {
            chroma += chroma_of(copy.chroma[k], shares_of(of_corner, copy.weights[k] * light_weights), lit);
        }
    }
    // Nodes of one chroma are looked up once: their weights add up to 1.
    if is_one_chroma {
        chroma = chroma_of(brdf.chroma.x, shares_of(lumas, light_weights), lit);
    }
    let luma_sum = total(lumas);
    var luma = luma_sum / 255.0;
    for (var stage = 1u; stage < min(codebooks.stages, 4u); stage++) {
        luma += later_luma(stage, brdf.texel, eye, lit);
    }
    if codebooks.is_relative == 1u {
        let fraction = select(vec2<f32>(0.0), chroma / max(luma_sum, 1e-30), luma_sum > 0.0);
        return vec3<f32>(luma, luma * (codebooks.first + codebooks.step * (fraction + brdf.tint)));
    }
    return vec3<f32>(luma, codebooks.first + codebooks.step * (chroma + brdf.tint));
}

// Shares of nodes in the chroma: by their luma, where chroma is divided by luma, else by their weights.
fn shares_of(lumas: vec4<f32>, weights: vec4<f32>) -> vec4<f32> {
    if codebooks.is_relative == 1u {
        return lumas;
    }
    return weights;
}
