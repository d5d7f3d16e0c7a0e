//! Numerical methods that several encoders share.

pub(crate) mod argmax;
pub(crate) mod banded;
pub(crate) mod eigen;
pub(crate) mod envelope;
pub(crate) mod k_means;
pub(crate) mod lanes;
pub(crate) mod lbfgs;
pub(crate) mod matrix;
pub(crate) mod parallel;
pub(crate) mod quadrature;
pub(crate) mod side_by_side;
pub(crate) mod svd;
pub(crate) mod uniform;
