//! Error of BSSRDF files against their captures: diffuse albedo, and the patch under three lights (Yatagawa et al. 2020,
//! section 4).

mod comparison;
mod judge;
mod light;
mod relit;

pub use comparison::{BssrdfError, Comparison, compare};
pub use judge::{Judgement, judge};
pub use light::Light;
pub use relit::Relit;
