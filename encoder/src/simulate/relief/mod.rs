//! BTFs of rough surfaces by rays on a relief, with masking, shadows and light between its parts.
//!
//! A [`Sample`] is a built-in material; [`Request`] simulates its images and writes a folder of them.

mod camera;
mod draw;
mod height_field;
mod light;
mod reflectance;
mod request;
mod samples;

pub use draw::simulate;
pub use request::Request;
pub use samples::Sample;
