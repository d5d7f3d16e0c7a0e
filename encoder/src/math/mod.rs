//! Numerical methods that several encoders use.

pub(crate) mod banded;
pub(crate) mod k_means;
pub(crate) mod lanes;
pub(crate) mod svd;
