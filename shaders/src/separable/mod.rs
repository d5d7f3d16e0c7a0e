//! Separable scattering: a material as a few weighted irradiance maps and shared Gaussians, heterogeneous scattering at the cost
//! of separable blurs.
//!
//! Rd(i, j) = f_i(r) f_j(r) with f_x(r) = exp(½ P̂_x(r)) (Yatagawa et al. 2020, eq. 2). A file's basis
//! ([`subsurf_decoder::bssrdf::SeparableBasis`]) has c_l(x) = Σ_h d_lh f_x(r_h), and
//!
//! M(x_o) = Σ_m c_m(x_o) Σ_l Σ_a w_lma (G_a * c_l E)(x_o),
//!
//! which takes L maps and A separable blurs of each, whatever the material.

mod basis;
mod numbers;
mod sums;

pub use basis::ProjectedBasis;
pub use numbers::BasisNumbers;
pub use sums::ProfileSums;
