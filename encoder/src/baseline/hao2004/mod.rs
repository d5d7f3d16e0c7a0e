//! Interpolation and the quantiser of Hao and Varshney 2004, *Real-time rendering of translucent meshes*.

mod lloyd;
mod nearest;

pub use lloyd::Lloyd;
pub use nearest::four_nearest;
