//! Kernels as they are written to files.

use subsurf_decoder::kernel::{KernelMethod, TwoGaussians};

/// Separable kernel of a homogeneous material, in taps.
///
/// What leaves at (x, y) is M_e(x, y) = Σ_t s_t Σ_i Σ_j w_{t,i} w_{t,j} E(x + o_i, y + o_j), channel by channel, over the taps
/// of both sides. Taps mirror at 0, so that one side is stored.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    /// Way by which it was made.
    pub method: KernelMethod,
    /// Reach of the profile in mm, larger than every offset; R_d is 0 beyond.
    pub radius: f32,
    /// Total diffuse reflectance ‖R_d‖₁ `[rgb]`, in (0, 1].
    pub reflectance: [f32; 3],
    /// Variance τ_max in mm² of exp(−d_z²/(2 τ_max)), by which taps fade with the difference in depth d_z in mm (section E).
    pub depth_variance: f32,
    /// Refractive index of the material against air, 1 to 4.
    pub eta: f32,
    /// Offsets o_i of one side in mm: `(taps + 1) / 2` of them, the first 0, ascending.
    pub offsets: Vec<f32>,
    /// Terms, the largest first: 1 to 6.
    pub terms: Vec<Term>,
    /// T(d) = ∫_d^∞ R_d(u) 2πu du `[i][rgb]` at d_i = radius (i / (m − 1))², m = 64: from the reflectance down to 0.
    ///
    /// The light that comes through a plate of thickness d (Jimenez et al. 2010, for any profile); its differences give the
    /// light of annuli, and so R_d.
    pub tail: Vec<[f32; 3]>,
    /// The two Gaussians by which an artist made it, if so.
    pub two_gaussians: Option<TwoGaussians>,
}

/// One separable term s a(x) a(y) of a [`Kernel`].
#[derive(Clone, Debug, PartialEq)]
pub struct Term {
    /// Signs s `[rgb]`, −1 or 1.
    pub sign: [i8; 3],
    /// Weights w_i `[tap][rgb]` of the taps of one side: ∫ a over the interval of the tap, which for the first is both sides of 0.
    pub weights: Vec<[f32; 3]>,
}
