// Angles by the polynomials of the decoder: built-ins of GLSL may be off by thousands of units in the last place.

const HALF_PI: f32 = 1.57079633;

// Angle of (x, y) from the x axis in rad, -pi to pi; 0 of (0, 0).
fn angle_of(y: f32, x: f32) -> f32 {
    let size = abs(vec2<f32>(x, y));
    let z = min(size.x, size.y) / max(max(size.x, size.y), 1.17549435e-38);
    // atan(z) / z in z^2: a minimax fit.
    let u = z * z;
    let low = (0.9999961 - u * 0.33317366) + u * u * (0.19807792 - u * 0.13233261);
    let high = (0.07962228 - u * 0.033603087) + u * u * 0.006811438;
    let first = z * (low + u * u * u * u * high);
    let quadrant = select(first, HALF_PI - first, size.x < size.y);
    let half = select(quadrant, 2.0 * HALF_PI - quadrant, x < 0.0);
    return select(half, -half, y < 0.0);
}

// Sine and cosine of an angle of -pi/2 to pi/2 rad: Taylor series of half of it.
fn sin_cos(angle: f32) -> vec2<f32> {
    let x = 0.5 * angle;
    let u = x * x;
    let s = x * (1.0 - u * (1.0 / 6.0 - u * (1.0 / 120.0 - u * (1.0 / 5040.0 - u / 362880.0))));
    let c = 1.0 - u * (0.5 - u * (1.0 / 24.0 - u * (1.0 / 720.0 - u / 40320.0)));
    return vec2<f32>(2.0 * s * c, max(1.0 - 2.0 * s * s, 0.0));
}
