// Directions on the grid [alpha, beta] x [theta_v, phi_v] (Havran, Filip and Myszkowski 2010, section 4.1).

// Coordinate between node `first` and the next.
struct LerpCoord {
    first: u32,
    // Weight of the next node, 0 to 1.
    weight: f32,
}

// Grid coordinates of a view; x is along the rows of the material, y down its columns, z its normal.
struct ViewCoord {
    phi: LerpCoord,
    theta: LerpCoord,
    // cos phi_v and sin phi_v.
    azimuth: vec2<f32>,
}

// Grid coordinates of a light, for a view.
struct LightCoord {
    alpha: LerpCoord,
    beta: LerpCoord,
    // Factor of values: 1 where lights were measured, less below, 0 below the horizon.
    fade: f32,
}

// Coordinate t in nodes from the first, clamped to 0 .. `end`; at the end, the weight is 1.
fn lerp_coord(t: f32, end: u32) -> LerpCoord {
    let clamped = clamp(t, 0.0, f32(end));
    let first = min(u32(clamped), end - 1u);
    return LerpCoord(first, clamped - f32(first));
}

// Coordinate of a value among `count` nodes from -`reach` to `reach`.
fn lerp_coord_around(value: f32, reach: f32, count: u32) -> LerpCoord {
    let middle = 0.5 * f32(count - 1u);
    return lerp_coord(value * (middle / reach) + middle, count - 1u);
}

// Grid coordinates of a unit vector towards the eye.
fn view_coord(view: vec3<f32>) -> ViewCoord {
    let sin_theta = length(view.xy);
    // Straight above, the azimuth is 0.
    var azimuth = vec2<f32>(1.0, 0.0);
    if sin_theta > 1e-6 {
        azimuth = view.xy / sin_theta;
    }
    let turns = angle_of(azimuth.y, azimuth.x) / (4.0 * HALF_PI);
    let ring_coord = select(turns, turns + 1.0, turns < 0.0) * f32(codebooks.nodes.w);
    let down = angle_of(sin_theta, view.z) * (f32(codebooks.nodes.z - 1u) / codebooks.theta_max);
    return ViewCoord(lerp_coord(ring_coord, codebooks.nodes.w), lerp_coord(down, codebooks.nodes.z - 1u), azimuth);
}

// Components of a direction along the azimuth of the view, and across its plane, which is sin beta.
fn in_frame(direction: vec3<f32>, azimuth: vec2<f32>) -> vec2<f32> {
    return vec2<f32>(dot(direction.xy, azimuth), direction.y * azimuth.x - direction.x * azimuth.y);
}

// Grid coordinates of a unit vector towards the light.
fn light_coord(light: vec3<f32>, azimuth: vec2<f32>) -> LightCoord {
    let frame = in_frame(light, azimuth);
    let alpha = lerp_coord_around(angle_of(frame.x, max(light.z, 0.0)), codebooks.alpha_max, codebooks.nodes.x);
    let above = max(light.z, 0.0);
    var fade = select(0.0, 1.0, above > 0.0);
    if above < codebooks.cos_light_min {
        fade = above / codebooks.cos_light_min;
    }
    return LightCoord(alpha, lerp_coord_around(frame.y, codebooks.sin_beta_max, codebooks.nodes.y), fade);
}
