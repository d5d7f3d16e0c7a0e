// Importance sampling of lights for nested codebooks, in proportion to the luma (Havran et al. 2010, section 5.2): it is linear
// between nodes and d omega = d alpha d(sin beta), so that its integrals can be inverted.

// Densities at the nodes of alpha, and from 64 on at those of beta, four to a vector.
var<private> densities: array<vec4<f32>, 32>;

// Density at a node.
fn density(node: u32) -> f32 {
    return densities[node >> 2u][node & 3u];
}

// Share of all samples of uniform density, so that it is nowhere 0.
const UNIFORM_SHARE: f32 = 0.03125;

// Integral above which its reciprocal is finite and its shares are normal numbers: 2^-103.
const LEAST_INTEGRAL: f32 = 9.8607613e-32;

// Piecewise linear density over `last` + 1 nodes, constant beyond them.
struct PiecewiseLinear {
    // Index of the first node in `densities`.
    base: u32,
    // Number of the last node, counted from 0.
    last: u32,
    // Distance of two nodes, and length of the constant pieces before the first and after the last.
    step: f32,
    end: f32,
    // Uniform density that is added, and the integral of both.
    floor: f32,
    integral: f32,
}

// Sample of a piecewise linear density.
struct LineSample {
    // Node before it, and weight of the next.
    place: LerpCoord,
    // Distance from the beginning.
    at: f32,
    // Probability density there.
    density: f32,
}

// Sampler of lights from a view, of the first stage: rows of P2 at the four nodes of view, exponents of c_P4 c_P3 in 1/64
// octaves, weights.
struct LightSampler {
    rows: vec4<u32>,
    exponents: vec4<i32>,
    weights: vec4<f32>,
    azimuth: vec2<f32>,
    alpha: PiecewiseLinear,
}

// Approximate scale of an exponent in 1/64 octaves, linear between powers of two: 2^(exponent / 64), up to 6.2 % more.
fn near_scale(exponent: i32) -> f32 {
    return bitcast<f32>(u32(clamp((exponent << 17u) + 0x3f800000, 0x00800000, 0x7f000000)));
}

// Density of the values in `densities` from `base` on: `count` nodes from -`reach` to `reach`, over -`half` to `half`.
fn piecewise_linear(base: u32, count: u32, reach: f32, half: f32) -> PiecewiseLinear {
    let last = min(count, 64u) - 1u;
    let step = 2.0 * reach / f32(last);
    let end = half - reach;
    var sum = 0.0;
    for (var k = 0u; k <= last; k++) {
        sum += density(base + k);
    }
    let ends = density(base) + density(base + last);
    let integral = step * (sum - 0.5 * ends) + end * ends;
    let even = 0.5 / half;
    // Nothing but zeros, or next to them: uniform.
    if integral > LEAST_INTEGRAL {
        let all = integral / (1.0 - UNIFORM_SHARE);
        return PiecewiseLinear(base, last, step, end, all * UNIFORM_SHARE * even, all);
    }
    return PiecewiseLinear(base, last, step, end, even, 1.0);
}

// Sample that has the share `part`, 0 to 1, of the density before it.
fn sample_line(line: PiecewiseLinear, part: f32) -> LineSample {
    let first = density(line.base) + line.floor;
    var rest = part * line.integral - line.end * first;
    if rest < 0.0 {
        return LineSample(LerpCoord(0u, 0.0), part * line.integral / first, first / line.integral);
    }
    // Up to the last node that is not beyond it.
    var node = 0u;
    var piece = 0.0;
    for (; node < line.last; node++) {
        piece = line.step * (0.5 * (density(line.base + node) + density(line.base + node + 1u)) + line.floor);
        if rest < piece {
            break;
        }
        rest -= piece;
    }
    if node >= line.last {
        let last = density(line.base + line.last) + line.floor;
        let at = line.end + f32(line.last) * line.step + min(rest / last, line.end);
        return LineSample(LerpCoord(line.last - 1u, 1.0), at, last / line.integral);
    }
    // low u + (high - low) u^2 / 2 = rest / step, in the form without cancellation; of an integral of 1.
    let low = (density(line.base + node) + line.floor) / line.integral;
    let slope = (density(line.base + node + 1u) - density(line.base + node)) / line.integral;
    let twice = 2.0 * rest / (line.step * line.integral);
    let weight = clamp(twice / (low + sqrt(max(low * low + slope * twice, 0.0))), 0.0, 1.0);
    return LineSample(LerpCoord(node, weight), line.end + (f32(node) + weight) * line.step, low + weight * slope);
}

// Probability density at a distance from the beginning, as `sample_line` gives it.
fn line_density(line: PiecewiseLinear, at: f32) -> f32 {
    let place = lerp_coord((at - line.end) / line.step, line.last);
    let low = density(line.base + place.first);
    let high = density(line.base + place.first + 1u);
    return (low + place.weight * (high - low) + line.floor) / line.integral;
}

// Sampler of a texel from a view.
fn light_sampler(brdf: ApparentBrdf, eye: ViewCoord) -> LightSampler {
    let of_p2 = codebooks.chains[3];
    var copy = brdf;
    // Codes of P2 are those of integrals over slices; c_P6 is common to all directions.
    for (var node = 0u; node < min(codebooks.nodes.x, 64u); node += 2u) {
        var integrals = vec2<f32>(0.0);
        for (var k = 0u; k < 4u; k++) {
            let codes = slices_of(0u, copy.rows[k], node).codes;
            let low = near_scale(copy.exponents[k] + exponent_of(of_p2, codes.x));
            let high = near_scale(copy.exponents[k] + exponent_of(of_p2, codes.y));
            integrals += copy.weights[k] * vec2<f32>(low, high);
        }
        let at = node >> 2u;
        if (node & 2u) == 0u {
            densities[at] = vec4<f32>(integrals, 0.0, 0.0);
        } else {
            densities[at] = vec4<f32>(densities[at].xy, integrals);
        }
    }
    let alpha = piecewise_linear(0u, codebooks.nodes.x, codebooks.alpha_max, HALF_PI);
    return LightSampler(brdf.rows, brdf.exponents, brdf.weights, eye.azimuth, alpha);
}

// Adds a slice times a factor to the densities of beta; values beyond the last node are not looked at.
fn add_slice(bit: u32, factor: f32, quads: u32) {
    let first = bit >> 5u;
    var low = word(first);
    for (var k = 0u; k < quads; k++) {
        let high = word(first + k + 1u);
        let bytes = vec4<u32>(joined(low, high, bit & 31u)) >> vec4<u32>(0u, 8u, 16u, 24u);
        densities[16u + k] += factor * vec4<f32>(bytes & vec4<u32>(255u));
        low = high;
    }
}

// Density of sin beta, -1 to 1: luma between the slices at a node of alpha and the next.
fn beta_line(source: LightSampler, alpha: LerpCoord) -> PiecewiseLinear {
    let of_p2 = codebooks.chains[3];
    let quads = min((codebooks.nodes.y + 3u) >> 2u, 16u);
    for (var k = 0u; k < quads; k++) {
        densities[16u + k] = vec4<f32>(0.0);
    }
    var copy = source;
    for (var k = 0u; k < 4u; k++) {
        let slices = slices_of(0u, copy.rows[k], alpha.first);
        let low = slice_at(0u, slices.rows.x);
        let high = slice_at(0u, slices.rows.y);
        let c_low = near_scale(copy.exponents[k] + exponent_of(of_p2, slices.codes.x) + slice_exponent(low));
        let c_high = near_scale(copy.exponents[k] + exponent_of(of_p2, slices.codes.y) + slice_exponent(high));
        add_slice(low, copy.weights[k] * (1.0 - alpha.weight) * c_low, quads);
        add_slice(high, copy.weights[k] * alpha.weight * c_high, quads);
    }
    return piecewise_linear(64u, codebooks.nodes.y, codebooks.sin_beta_max, 1.0);
}

// Unit vector towards the light at sine and cosine of alpha and at sin beta, for the azimuth of a view.
fn light_direction(alpha: vec2<f32>, sin_beta: f32, azimuth: vec2<f32>) -> vec3<f32> {
    let cos_beta = sqrt(max(1.0 - sin_beta * sin_beta, 0.0));
    let forward = cos_beta * alpha.x;
    return vec3<f32>(
        forward * azimuth.x - sin_beta * azimuth.y,
        forward * azimuth.y + sin_beta * azimuth.x,
        cos_beta * alpha.y,
    );
}

// Unit vector towards a light, z >= 0, for two random numbers, 0 to 1, and its density per steradian.
fn sample_light(source: LightSampler, random: vec2<f32>) -> vec4<f32> {
    let alpha = sample_line(source.alpha, random.x);
    let beta = sample_line(beta_line(source, alpha.place), random.y);
    let light = light_direction(sin_cos(alpha.at - HALF_PI), beta.at - 1.0, source.azimuth);
    return vec4<f32>(light, alpha.density * beta.density);
}

// Density of a light per steradian; 0 below the horizon.
fn light_density(source: LightSampler, light: vec3<f32>) -> f32 {
    if light.z < 0.0 {
        return 0.0;
    }
    let frame = in_frame(light, source.azimuth);
    let alpha = angle_of(frame.x, light.z);
    let line = beta_line(source, lerp_coord_around(alpha, codebooks.alpha_max, codebooks.nodes.x));
    return line_density(source.alpha, alpha + HALF_PI) * line_density(line, frame.y + 1.0);
}
