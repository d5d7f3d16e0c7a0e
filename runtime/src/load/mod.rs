//! Loading: from a file to a material on the device, in steps.

mod first_frame;
mod materials;
mod projection;
mod steps;
mod stored;
mod timer;
mod work;

pub use steps::Load;
pub use stored::{RawImages, Stored};
pub use timer::{LoadTimer, LoadTimes};
pub use work::LoadPhase;
