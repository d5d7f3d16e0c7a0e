// Lights in proportion to what a texel shows of them (Havran et al. 2010, section 5.2): luma is linear between nodes and
// d omega = d alpha d(sin beta), so that its integrals have inverses.

// Densities at the nodes of alpha, and from 64 on at those of beta, four at a time.
var<private> densities: array<vec4<f32>, 32>;

fn density(node: u32) -> f32 {
    return densities[node >> 2u][node & 3u];
}

// Share of all draws that fall anywhere with the same density, so that it is nowhere 0.
const ANYWHERE: f32 = 0.03125;

// A density that is linear between `last` + 1 nodes and constant beyond them.
struct Line {
    // Of the first node in `densities`.
    base: u32,
    last: u32,
    // Distance of two nodes, and length of the constant piece before the first and after the last.
    step: f32,
    end: f32,
    // What is added to all values, and the integral of both.
    floor: f32,
    integral: f32,
}

// A place on a line.
struct Drawn {
    // The node before it, and the weight of the next.
    place: Place,
    // Length from the beginning of the line.
    at: f32,
    // Share of draws per length there.
    density: f32,
}

// Of the first stage at a view: P2 of the four nodes of view, exponents of c_P4 c_P3 and weights.
struct Sampler {
    rows: vec4<u32>,
    exponents: vec4<i32>,
    weights: vec4<f32>,
    azimuth: vec2<f32>,
    alpha: Line,
}

// What lies on straight lines between powers of two: 2^(exponent / 64), up to 6.2 % more.
fn near(exponent: i32) -> f32 {
    return bitcast<f32>(u32(clamp((exponent << 17u) + 0x3f800000, 0x00800000, 0x7f000000)));
}

// The line of the values that stand in `densities` from `base` on, `count` nodes from -`reach` to `reach` over -`half` to `half`.
fn line_of(base: u32, count: u32, reach: f32, half: f32) -> Line {
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
    // Nothing but zeros: all places are alike.
    if integral > 0.0 {
        let all = integral / (1.0 - ANYWHERE);
        return Line(base, last, step, end, all * ANYWHERE * even, all);
    }
    return Line(base, last, step, end, even, 1.0);
}

// The place that has the share `part`, 0 to 1, of the density before it.
fn draw_on(line: Line, part: f32) -> Drawn {
    let first = density(line.base) + line.floor;
    var rest = part * line.integral - line.end * first;
    if rest < 0.0 {
        return Drawn(Place(0u, 0.0), part * line.integral / first, first / line.integral);
    }
    // To the last node that does not lie beyond it.
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
        return Drawn(Place(line.last - 1u, 1.0), at, last / line.integral);
    }
    // low u + (high - low) u^2 / 2 = rest / step, in the form that subtracts nothing from nothing; of an integral of 1.
    let low = (density(line.base + node) + line.floor) / line.integral;
    let slope = (density(line.base + node + 1u) - density(line.base + node)) / line.integral;
    let twice = 2.0 * rest / (line.step * line.integral);
    let weight = clamp(twice / (low + sqrt(max(low * low + slope * twice, 0.0))), 0.0, 1.0);
    return Drawn(Place(node, weight), line.end + (f32(node) + weight) * line.step, low + weight * slope);
}

// Density at a place, as `draw_on` gives it.
fn density_at(line: Line, at: f32) -> f32 {
    let place = place_at((at - line.end) / line.step, line.last);
    let low = density(line.base + place.first);
    let high = density(line.base + place.first + 1u);
    return (low + place.weight * (high - low) + line.floor) / line.integral;
}

fn sampler_of(apparent: Apparent, seen: Seen) -> Sampler {
    let of_p2 = books.chains[3];
    var copy = apparent;
    // Codes of P2 are those of integrals over slices; c_P6 is common to all directions.
    for (var node = 0u; node < min(books.nodes.x, 64u); node += 2u) {
        var integrals = vec2<f32>(0.0);
        for (var k = 0u; k < 4u; k++) {
            let codes = slices_of(0u, copy.rows[k], node).codes;
            let low = near(copy.exponents[k] + exponent_of(of_p2, codes.x));
            let high = near(copy.exponents[k] + exponent_of(of_p2, codes.y));
            integrals += copy.weights[k] * vec2<f32>(low, high);
        }
        let at = node >> 2u;
        if (node & 2u) == 0u {
            densities[at] = vec4<f32>(integrals, 0.0, 0.0);
        } else {
            densities[at] = vec4<f32>(densities[at].xy, integrals);
        }
    }
    let alpha = line_of(0u, books.nodes.x, books.alpha_max, HALF_PI);
    return Sampler(apparent.rows, apparent.exponents, apparent.weights, seen.azimuth, alpha);
}

// Adds a slice times a factor to the line of beta; what is beyond the last node is not looked at.
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

// Of sin beta, from -1 to 1, by luma between the slices at a node of alpha and the next.
fn beta_line(source: Sampler, alpha: Place) -> Line {
    let of_p2 = books.chains[3];
    let quads = min((books.nodes.y + 3u) >> 2u, 16u);
    for (var k = 0u; k < quads; k++) {
        densities[16u + k] = vec4<f32>(0.0);
    }
    var copy = source;
    for (var k = 0u; k < 4u; k++) {
        let slices = slices_of(0u, copy.rows[k], alpha.first);
        let low = slice_at(0u, slices.rows.x);
        let high = slice_at(0u, slices.rows.y);
        let c_low = near(copy.exponents[k] + exponent_of(of_p2, slices.codes.x) + height_of(low));
        let c_high = near(copy.exponents[k] + exponent_of(of_p2, slices.codes.y) + height_of(high));
        add_slice(low, copy.weights[k] * (1.0 - alpha.weight) * c_low, quads);
        add_slice(high, copy.weights[k] * alpha.weight * c_high, quads);
    }
    return line_of(64u, books.nodes.y, books.sin_beta_max, 1.0);
}

// The light at sine and cosine of alpha and at sin beta, for the azimuth of a view.
fn light_at(alpha: vec2<f32>, sin_beta: f32, azimuth: vec2<f32>) -> vec3<f32> {
    let cos_beta = sqrt(max(1.0 - sin_beta * sin_beta, 0.0));
    let forward = cos_beta * alpha.x;
    return vec3<f32>(
        forward * azimuth.x - sin_beta * azimuth.y,
        forward * azimuth.y + sin_beta * azimuth.x,
        cos_beta * alpha.y,
    );
}

// Unit vector towards a light, z >= 0, for two random numbers, 0 to 1; and its density per steradian.
fn sampled(source: Sampler, random: vec2<f32>) -> vec4<f32> {
    let alpha = draw_on(source.alpha, random.x);
    let beta = draw_on(beta_line(source, alpha.place), random.y);
    let light = light_at(sin_cos(alpha.at - HALF_PI), beta.at - 1.0, source.azimuth);
    return vec4<f32>(light, alpha.density * beta.density);
}

// The density with which a light is drawn, per steradian; 0 below the horizon.
fn density_of(source: Sampler, light: vec3<f32>) -> f32 {
    if light.z < 0.0 {
        return 0.0;
    }
    let frame = in_frame(light, source.azimuth);
    let alpha = angle_of(frame.x, light.z);
    let line = beta_line(source, place_around(alpha, books.alpha_max, books.nodes.x));
    return density_at(source.alpha, alpha + HALF_PI) * density_at(line, frame.y + 1.0);
}
