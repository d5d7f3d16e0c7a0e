// The reference pass on a flat patch: exitance(x_o) = sum over the window of Rd(x_i, x_o) E(x_i) pitch^2.

struct View {
    // Pixel of the patch that the target's first texel shows.
    origin: vec2<u32>,
    pad: vec2<u32>,
}

@group(1) @binding(0) var<uniform> view: View;
// Irradiance that has entered the material, after Fresnel transmission; linear rgb.
@group(1) @binding(1) var irradiance: texture_2d<f32>;

@fragment
fn gather(@builtin(position) at: vec4<f32>) -> @location(0) vec4<f32> {
    let x_o = vec2<i32>(at.xy) + vec2<i32>(view.origin);
    let o = load_pixel(address(x_o));
    let radius = i32(material.window_radius);
    var sum = vec3<f32>(0.0);
    for (var dy = -radius; dy <= radius; dy++) {
        for (var dx = -radius; dx <= radius; dx++) {
            let step = vec2<i32>(dx, dy);
            let r_mm = sqrt(f32(dx * dx + dy * dy)) * material.pitch_mm;
            if r_mm <= material.r_max_mm {
                let x_i = address(x_o + step);
                let e = textureLoad(irradiance, x_i, 0).xyz;
                sum += reflectance(load_pixel(x_i), o, step, r_mm) * e;
            }
        }
    }
    return vec4<f32>(sum * material.pitch_mm * material.pitch_mm, 1.0);
}
