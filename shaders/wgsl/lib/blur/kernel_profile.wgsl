// Profile of a homogeneous material.

struct KernelProfile {
    // ||R_d||_1, 0 to 1; linear Rec. 709.
    reflectance: vec4<f32>,
    // Distance in mm beyond which nothing scatters.
    radius_mm: f32,
    // Number of the last node of the tail.
    last_node: u32,
    // Standard deviation in mm of light that spreads on its way through thin parts: that of tau_max.
    spread_mm: f32,
    pad: u32,
}

@group(1) @binding(0) var<uniform> profile: KernelProfile;
