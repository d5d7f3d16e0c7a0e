// Gaussians of LinSSS (Yatagawa et al. 2020b): Rd = 1/2 sum over h of (W_h(x_o) + W_h(x_i)) G(r; sigma_h).

const MAX_LINSSS_GAUSSIANS: u32 = 8u;

struct Linsss {
    // sigma_h by channel, in mm.
    sigmas_mm: array<vec4<f32>, MAX_LINSSS_GAUSSIANS>,
    // H, 1 to 8.
    gaussians: u32,
    // 1 if layer h is W_h, and light is weighted where it enters, too; 0 if it is W_h + G_h * W_h, which stands for both.
    is_exact: u32,
    // Number of the Gaussian whose weighted light is drawn.
    turn: u32,
    pad: u32,
}
