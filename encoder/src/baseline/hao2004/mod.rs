//! What Hao and Varshney 2004, *Real-time rendering of translucent meshes*, store, and how they interpolate.

mod harmonics;
mod lloyd;
mod nearest;
mod reference_points;
mod tiling;

pub use harmonics::Harmonics;
pub use lloyd::{LLOYD_ROUNDS, Lloyd};
pub use nearest::four_nearest;
pub use reference_points::ReferencePoints;
pub use tiling::Tiling;
