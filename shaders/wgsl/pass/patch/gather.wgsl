// Needs: <target format>, <material layout>, fullscreen.
// Reference pass on a flat patch: exitance(x_o) = sum over the window of Rd(x_i, x_o) E(x_i) pitch^2.

struct PatchRegion {
    // Pixel of the patch, column and row, that the first texel of the target shows.
    origin: vec2<u32>,
    pad: vec2<u32>,
}

@group(1) @binding(0) var<uniform> region: PatchRegion;
// Irradiance that has entered the material, after Fresnel transmission; linear Rec. 709.
@group(1) @binding(1) var irradiance: texture_2d<f32>;

// Step k of the eight of the same length that mirror (a, b), a >= b >= 0, at the axes and at the diagonals.
fn mirrored(a: i32, b: i32, k: u32) -> vec2<i32> {
    let swapped = select(vec2<i32>(a, b), vec2<i32>(b, a), (k & 4u) != 0u);
    return swapped * vec2<i32>(1 - i32(k & 2u), 1 - 2 * i32(k & 1u));
}

@fragment
fn gather(@builtin(position) at: vec4<f32>) -> @location(0) TargetTexel {
    let x_o = vec2<i32>(at.xy) + vec2<i32>(region.origin);
    let o = load_pixel(address(x_o));
    let radius = i32(material.window_radius);
    var sum = vec3<f32>(0.0);
    for (var a = 0; a <= radius; a++) {
        for (var b = 0; b <= a; b++) {
            let r_mm = sqrt(f32(a * a + b * b)) * material.pitch_mm;
            if r_mm > material.r_max_mm {
                continue;
            }
            let partner = partner_at(o, r_mm);
            for (var k = 0u; k < 8u; k++) {
                // Mirror images that fall together count once.
                let twice = (a == 0 && k > 0u) || (b == 0 && (k == 1u || k == 3u || k == 6u || k == 7u)) || (a == b && k > 3u);
                if twice {
                    continue;
                }
                let step = mirrored(a, b, k);
                let x_i = address(x_o + step);
                let e = textureLoad(irradiance, x_i, 0).xyz;
                sum += reflectance(load_pixel(x_i), partner, step) * e;
            }
        }
    }
    return pack(vec4<f32>(sum * material.pitch_mm * material.pitch_mm, 1.0));
}
