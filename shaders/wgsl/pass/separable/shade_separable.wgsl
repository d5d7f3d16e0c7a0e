// Needs: <target format>, <terms>, tone, display, fresnel, object, scene, coat, mapping, host_shadow, tsm_visibility, patch_layers, separable_basis, visibilities, vertex_none, vertex, neighbours, upsampling, sums, shading.
// Picture of a mesh from blurred maps on the screen: M = sum over m of c_m S_m, and the scattered light of the environment.

// S_m; depth in mm in the fourth channel.
@group(1) @binding(3) var sums: TargetMaps;

// Exitance of a fragment; linear Rec. 709.
fn exitance(in: Varying, normal: vec3<f32>) -> vec3<f32> {
    var c = basis_at(lookup_of(in));
    var light = sums_at(in.clip.xy, depth_of(in.position_mm));
    var sum = c[TERMS] * scattered_sky(in, normal);
    for (var m = 0u; m < TERMS; m++) {
        sum += c[m] * light[m];
    }
    return max(sum, vec3<f32>(0.0));
}

// Visibility of light `i`, 0 to 1.
fn light_visibility(i: u32, in: Varying, normal: vec3<f32>) -> f32 {
    return visibility(i, in.position_mm, normal);
}

@fragment
fn shade_separable(in: Varying) -> @location(0) vec4<f32> {
    return shaded(in);
}
