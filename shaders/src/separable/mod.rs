//! Separable scattering: a material as a few weighted irradiance maps and shared Gaussians, heterogeneous scattering at the cost
//! of separable blurs.
//!
//! Rd(i, j) = f_i(r) f_j(r) with f_x(r) = exp(½ P̂_x(r)) (Yatagawa et al. 2020, eq. 2). With f_x(r) ≈ Σ_l c_l(x) g_l(r) and
//! every product g_l g_m as a sum of the same A Gaussians,
//!
//! M(x_o) = Σ_m c_m(x_o) Σ_l Σ_a w_lma (G_a * c_l E)(x_o),
//!
//! which takes L maps and A separable blurs of each, whatever the material.

mod basis;
mod cascade;

pub use basis::{BasisSize, MAX_GAUSSIANS, MAX_TERMS, SeparableBasis};
pub use cascade::CascadeStage;
