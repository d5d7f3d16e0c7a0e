// Colour encodings of nested codebooks: from luma and chroma to linear Rec. 709.

// Linear Rec. 709 of luma and chroma. The fade of low lights is applied to what the images hold: display values, or light.
fn linear_rgb(channels: vec3<f32>, fade: f32) -> vec3<f32> {
    if codebooks.colour_encoding == 1u {
        // Y, Cr = 0.713 (R - Y) and Cb = 0.564 (B - Y).
        let red = channels.x + channels.y / 0.713;
        let blue = channels.x + channels.z / 0.564;
        let green = (channels.x - 0.299 * red - 0.114 * blue) / 0.587;
        let display = clamp(vec3<f32>(red, green, blue), vec3<f32>(0.0), vec3<f32>(1.0));
        return codebooks.white * linear_from_srgb(display * fade);
    }
    // LogLuv (Larson 1998, with a toe): L = toe (2^(l octaves) - 1), and u' and v' of CIE 1976.
    let luminance = codebooks.white * (exp2(clamp(channels.x, 0.0, 2.0) * codebooks.octaves) - 1.0);
    let u = clamp(channels.y, 0.0, 1.0);
    let v = clamp(channels.z, 0.01, 1.0);
    let x = 2.25 * u / v;
    let z = (3.0 - 0.75 * u) / v - 5.0;
    let rgb = vec3<f32>(
        3.24097 * x - 1.537383 - 0.498611 * z,
        1.875968 - 0.969244 * x + 0.041555 * z,
        0.05563 * x - 0.203977 + 1.056972 * z,
    );
    return max(rgb * luminance, vec3<f32>(0.0)) * fade;
}

// Value of a BTF: pi times the radiance under light of unit irradiance on a plane that faces it (a white diffuser has
// cos theta_i), linear Rec. 709; `light` is a unit vector.
fn btf_value(brdf: ApparentBrdf, light: vec3<f32>, eye: ViewCoord) -> vec3<f32> {
    let lit = light_coord(light, eye.azimuth);
    if lit.fade <= 0.0 {
        return vec3<f32>(0.0);
    }
    return linear_rgb(luma_chroma(brdf, eye, lit), lit.fade);
}
