// The [alpha, beta] x [theta_v, phi_v] parametrisation (Havran, Filip and Myszkowski 2010, section 4.1).

// Between node `first` and the next.
struct Place {
    first: u32,
    // Of the next, 0 to 1.
    weight: f32,
}

// A view: x along the rows of the material, y down its columns, z its normal.
struct Seen {
    phi: Place,
    theta: Place,
    // cos phi_v and sin phi_v.
    azimuth: vec2<f32>,
}

// A light, for a view.
struct Lit {
    alpha: Place,
    beta: Place,
    // What values are multiplied by: 1 where lights were measured, less below, 0 below the horizon.
    fade: f32,
}

// t in nodes from the first, clamped to 0 .. `end`; at the end, the weight is 1.
fn place_at(t: f32, end: u32) -> Place {
    let clamped = clamp(t, 0.0, f32(end));
    let first = min(u32(clamped), end - 1u);
    return Place(first, clamped - f32(first));
}

// `value` among `count` nodes from -`reach` to `reach`.
fn place_around(value: f32, reach: f32, count: u32) -> Place {
    let middle = 0.5 * f32(count - 1u);
    return place_at(value * (middle / reach) + middle, count - 1u);
}

fn seen_from(view: vec3<f32>) -> Seen {
    let sin_theta = length(view.xy);
    // Straight above, the azimuth is 0.
    var azimuth = vec2<f32>(1.0, 0.0);
    if sin_theta > 1e-6 {
        azimuth = view.xy / sin_theta;
    }
    let turns = angle_of(azimuth.y, azimuth.x) / (4.0 * HALF_PI);
    let around = select(turns, turns + 1.0, turns < 0.0) * f32(books.nodes.w);
    let down = angle_of(sin_theta, view.z) * (f32(books.nodes.z - 1u) / books.theta_max);
    return Seen(place_at(around, books.nodes.w), place_at(down, books.nodes.z - 1u), azimuth);
}

// A direction along the view's azimuth, and across its plane, which is sin beta.
fn in_frame(direction: vec3<f32>, azimuth: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(dot(direction.xy, azimuth), direction.y * azimuth.x - direction.x * azimuth.y);
}

fn lit_from(light: vec3<f32>, azimuth: vec2<f32>) -> Lit {
    let frame = in_frame(light, azimuth);
    let alpha = place_around(angle_of(frame.x, max(light.z, 0.0)), books.alpha_max, books.nodes.x);
    let above = max(light.z, 0.0);
    var fade = select(0.0, 1.0, above > 0.0);
    if above < books.cos_light_min {
        fade = above / books.cos_light_min;
    }
    return Lit(alpha, place_around(frame.y, books.sin_beta_max, books.nodes.y), fade);
}
