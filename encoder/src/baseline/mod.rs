//! What only comparisons need: earlier methods, from their papers.

pub mod hao2004;
pub mod havran2010;
pub mod linsss;
pub mod song2009;
pub mod whole_brdf;
pub(crate) mod yatagawa2020;
