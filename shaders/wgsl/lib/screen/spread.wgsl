// Places that light spreads to on its way through thin parts, and how far it goes there by a host's map.

// Distance of places around a position in texels of `texel_mm`: nine of them, as far apart as the widest Gaussian reaches from one to
// the next.
fn spread_texels(widest_mm: f32, texel_mm: f32) -> f32 {
    return clamp(0.8 * widest_mm / texel_mm, 1.0, 128.0);
}

// Binomial weight of the place that is `step` away in columns and rows, each -1 to 1.
fn spread_weight(step: vec2<i32>) -> f32 {
    return f32((2 - abs(step.x)) * (2 - abs(step.y))) / 16.0;
}

// Ray from a position towards a light, as the host's map sees it.
struct HostRay {
    // Clip coordinates of the position, and their change in a mm.
    start: vec4<f32>,
    slope: vec4<f32>,
    // Depth where nothing is seen.
    furthest: f32,
}

// Ray from a position in mm towards light i.
fn host_ray(i: u32, position_mm: vec3<f32>, towards: vec3<f32>) -> HostRay {
    let source = scene.light[min(i, MAX_LIGHTS - 1u)];
    return HostRay(
        source.clip_from_world * vec4<f32>(position_mm, 1.0),
        source.clip_from_world * vec4<f32>(towards, 0.0),
        select(1.0, 0.0, source.shadow == HOST_SHADOW_REVERSED),
    );
}

// Length of a ray to a depth of the map in mm; -1 where nothing is seen, for nothing enters there.
fn thickness(ray: HostRay, depth: f32) -> f32 {
    // Depth along the ray is (z + t dz) / (w + t dw), t mm away.
    let change = ray.slope.z - depth * ray.slope.w;
    if depth == ray.furthest || change == 0.0 {
        return -1.0;
    }
    return abs((depth * ray.start.w - ray.start.z) / change);
}
