// Values of apparent BRDFs by chained look-ups (Havran et al. 2010, eq. 4), linear between the nodes of all four axes.

// The four nodes of view around a place, [phi][theta].
struct Corners {
    // Of M, or of P2 in later stages.
    rows: vec4<u32>,
    // Of c_P6 c_P4 c_P3, in 1/64 octaves.
    exponents: vec4<i32>,
    // Add up to 1, but for the signs of c_P6 c_P4 c_P3.
    weights: vec4<f32>,
}

// 2^(exponent / 64).
fn scale_of(exponent: i32) -> f32 {
    let octave = bitcast<f32>(u32(clamp((exponent >> 6u) + 127, 1, 254)) << 23u);
    return exp2(f32(exponent & 63) / 64.0) * octave;
}

fn exponent_of(table: BtfTable, code: u32) -> i32 {
    return table.offset + i32((code & table.code_mask) << table.step);
}

fn sign_of(table: BtfTable, code: u32) -> f32 {
    return 1.0 - 2.0 * f32((code >> table.sign_at) & table.sign_mask);
}

// Of row `p4` of P4, times c_P6 of that exponent and sign.
fn corners_of(stage: u32, p4: u32, exponent: i32, sign: f32, seen: Seen) -> Corners {
    let of_p4 = books.chains[4u * stage + 1u];
    let of_p3 = books.chains[4u * stage + 2u];
    var corners: Corners;
    for (var k = 0u; k < 2u; k++) {
        // P3 at phi_v of P4; node n_phi is node 0.
        let node = seen.phi.first + k;
        let item = bits_at(item_at(of_p4, p4, select(node, 0u, node == books.nodes.w)));
        let code = item >> of_p4.index_bits;
        let so_far = exponent + exponent_of(of_p4, code);
        let weight = select(1.0 - seen.phi.weight, seen.phi.weight, k == 1u) * sign * sign_of(of_p4, code);
        // And at theta_v and the next.
        let items = two_at(item_at(of_p3, index_of(of_p4, item), seen.theta.first), of_p3.width);
        let codes = items >> vec2<u32>(of_p3.index_bits);
        let rows = vec2<u32>(index_of(of_p3, items.x), index_of(of_p3, items.y));
        let exponents = so_far + vec2<i32>(exponent_of(of_p3, codes.x), exponent_of(of_p3, codes.y));
        let signs = vec2<f32>(sign_of(of_p3, codes.x), sign_of(of_p3, codes.y));
        let weights = weight * signs * vec2<f32>(1.0 - seen.theta.weight, seen.theta.weight);
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

fn slices_of(stage: u32, p2: u32, node: u32) -> Slices {
    let table = books.chains[4u * stage + 3u];
    let items = two_at(item_at(table, p2, node), table.width);
    let bytes = bits_at(books.p2_bytes[stage] + 8u * (p2 * books.nodes.x + node));
    // The lowest eight bits stand apart; what is above the code's own bits is never looked at.
    let codes = (vec2<u32>(bytes, bytes >> 8u) & vec2<u32>(255u)) | ((items >> vec2<u32>(table.index_bits)) << vec2<u32>(8u));
    return Slices(vec2<u32>(index_of(table, items.x), index_of(table, items.y)), codes);
}

// First bit of a row of P1.
fn slice_at(stage: u32, row: u32) -> u32 {
    return books.p1[stage] + 8u * row * (books.nodes.y + 1u);
}

// A slice at a node of beta and the next, in steps of a code.
fn slice_values(stage: u32, bit: u32, node: u32) -> vec2<f32> {
    let bytes = bits_at(bit + 8u * node);
    if books.is_signed[stage] == 1u {
        return vec2<f32>(f32(i32(bytes << 24u) >> 24u), f32(i32(bytes << 16u) >> 24u));
    }
    return vec2<f32>(f32(bytes & 255u), f32((bytes >> 8u) & 255u));
}

// What the height at the end of a slice adds to exponents: it is in 1/32 octaves.
fn height_of(bit: u32) -> i32 {
    return 2 * i32(byte_at(bit + 8u * books.nodes.y));
}

// Luma of the four nodes of light, [alpha][beta], in steps of a code, times all weights.
fn lumas_of(stage: u32, p2: u32, exponent: i32, weight: f32, lit: Lit) -> vec4<f32> {
    let table = books.chains[4u * stage + 3u];
    let slices = slices_of(stage, p2, lit.alpha.first);
    let weights = vec2<f32>(1.0 - lit.beta.weight, lit.beta.weight);
    let low = slice_at(stage, slices.rows.x);
    let high = slice_at(stage, slices.rows.y);
    let c_low = scale_of(exponent + exponent_of(table, slices.codes.x) + height_of(low));
    let c_high = scale_of(exponent + exponent_of(table, slices.codes.y) + height_of(high));
    let of_low = weight * (1.0 - lit.alpha.weight) * sign_of(table, slices.codes.x) * c_low;
    let of_high = weight * lit.alpha.weight * sign_of(table, slices.codes.y) * c_high;
    return vec4<f32>(
        of_low * weights * slice_values(stage, low, lit.beta.first),
        of_high * weights * slice_values(stage, high, lit.beta.first),
    );
}

fn total(values: vec4<f32>) -> f32 {
    return (values.x + values.y) + (values.z + values.w);
}

// P2 and I2 of a row of M.
fn merged_row(row: u32) -> vec2<u32> {
    let bits = bits_at(item_at(books.merged, row, 0u));
    return vec2<u32>(index_of(books.merged, bits), min((bits >> books.merged.index_bits) & books.i2_mask, books.last_i2));
}

// Codes of a and b.
fn chroma_codes(bit: u32) -> vec2<f32> {
    let codes = bits_at(bit);
    return vec2<f32>(f32(codes & 255u), f32((codes >> 8u) & 255u));
}

fn colour_codes(entry: u32) -> vec2<f32> {
    return chroma_codes(books.colours + 16u * entry);
}

// Codes of chroma of a row of I2 at the four nodes of light, each times its share.
fn hues_of(i2: u32, shares: vec4<f32>, lit: Lit) -> vec2<f32> {
    let rows = two_at(item_at(books.i2, i2, lit.alpha.first), books.i2.width);
    let low = two_at(item_at(books.i1, index_of(books.i2, rows.x), lit.beta.first), books.i1.width);
    let high = two_at(item_at(books.i1, index_of(books.i2, rows.y), lit.beta.first), books.i1.width);
    return shares.x * colour_codes(index_of(books.i1, low.x)) + shares.y * colour_codes(index_of(books.i1, low.y))
        + shares.z * colour_codes(index_of(books.i1, high.x)) + shares.w * colour_codes(index_of(books.i1, high.y));
}

// Luma that a stage after the first adds.
fn later_luma(stage: u32, texel: u32, seen: Seen, lit: Lit) -> f32 {
    let of_p6 = books.chains[4u * stage];
    let item = bits_at(item_at(of_p6, texel, 0u));
    let code = item >> of_p6.index_bits;
    var corners = corners_of(stage, index_of(of_p6, item), exponent_of(of_p6, code), sign_of(of_p6, code), seen);
    var sum = 0.0;
    for (var k = 0u; k < 4u; k++) {
        sum += total(lumas_of(stage, corners.rows[k], corners.exponents[k], corners.weights[k], lit));
    }
    return sum / select(255.0, 127.0, books.is_signed[stage] == 1u);
}

// What a texel looks like from a view, under any light: the first stage as far as no light is known.
struct Apparent {
    texel: u32,
    // Of P2 and of I2, at the four nodes of view.
    rows: vec4<u32>,
    hues: vec4<u32>,
    // Of c_P4 c_P3 there, and of c_P6.
    exponents: vec4<i32>,
    of_texel: i32,
    weights: vec4<f32>,
    // In steps of a code.
    tint: vec2<f32>,
}

fn apparent_of(texel: u32, seen: Seen) -> Apparent {
    let of_p6 = books.chains[0];
    let item = bits_at(item_at(of_p6, texel, 0u));
    var corners = corners_of(0u, index_of(of_p6, item), 0, 1.0, seen);
    var rows: vec4<u32>;
    var hues: vec4<u32>;
    for (var k = 0u; k < 4u; k++) {
        let merged = merged_row(corners.rows[k]);
        rows[k] = merged.x;
        hues[k] = merged.y;
    }
    var tint = vec2<f32>(0.0);
    if books.tint_count > 0u {
        let number = (item & mask_of(of_p6.width)) >> books.tint_at;
        tint = chroma_codes(books.tints + 16u * min(number, books.tint_count - 1u)) - 128.0;
    }
    let of_texel = exponent_of(of_p6, item >> of_p6.index_bits);
    return Apparent(texel, rows, hues, corners.exponents, of_texel, corners.weights, tint);
}

// Luma and chroma, without the fading of low lights.
fn channels_of(apparent: Apparent, seen: Seen, lit: Lit) -> vec3<f32> {
    var copy = apparent;
    let betas = vec2<f32>(1.0 - lit.beta.weight, lit.beta.weight);
    let light_weights = vec4<f32>((1.0 - lit.alpha.weight) * betas, lit.alpha.weight * betas);
    let is_one_hue = all(apparent.hues == apparent.hues.xxxx);
    var lumas = vec4<f32>(0.0);
    var hues = vec2<f32>(0.0);
    for (var k = 0u; k < 4u; k++) {
        let of_corner = lumas_of(0u, copy.rows[k], apparent.of_texel + copy.exponents[k], copy.weights[k], lit);
        lumas += of_corner;
        if !is_one_hue {
            hues += hues_of(copy.hues[k], shares_of(of_corner, copy.weights[k] * light_weights), lit);
        }
    }
    // Neighbours of one colour are looked up once: their weights add up to 1.
    if is_one_hue {
        hues = hues_of(apparent.hues.x, shares_of(lumas, light_weights), lit);
    }
    let luma_sum = total(lumas);
    var luma = luma_sum / 255.0;
    for (var stage = 1u; stage < min(books.stages, 4u); stage++) {
        luma += later_luma(stage, apparent.texel, seen, lit);
    }
    if books.is_relative == 1u {
        let fraction = select(vec2<f32>(0.0), hues / max(luma_sum, 1e-30), luma_sum > 0.0);
        return vec3<f32>(luma, luma * (books.first + books.step * (fraction + apparent.tint)));
    }
    return vec3<f32>(luma, books.first + books.step * (hues + apparent.tint));
}

// Where chroma is divided by luma, the brighter of the nodes count for more.
fn shares_of(lumas: vec4<f32>, weights: vec4<f32>) -> vec4<f32> {
    if books.is_relative == 1u {
        return lumas;
    }
    return weights;
}
