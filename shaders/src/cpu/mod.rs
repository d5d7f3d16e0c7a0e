//! The passes on the CPU: the reference for the GPU's numbers, and a renderer where there is no GPU.
//!
//! Colours are linear Rec. 709. Where the GPU stores a result in a half-float texture, the twin keeps f32.

mod btf;
mod coat;
mod fresnel;
mod gather;
mod irradiance;
mod present;
mod raster;
mod scene;
mod separable;
mod shade;
mod surface_gather;
mod tone;

pub use btf::{BtfSurface, BtfTriangles, shade_btf};
pub use coat::{Reflections, glint, sheen};
pub use fresnel::{diffuse_transmittance, fresnel_transmittance};
pub use gather::{Reflectance, gather};
pub use irradiance::irradiance;
pub use present::present;
pub use scene::{entering, incident, sky_irradiance};
pub use separable::separable;
pub use shade::{Triangles, shade};
pub use surface_gather::surface_gather;
pub use tone::{display, linear, neutral, srgb};

/// Linear red, green and blue.
pub type Rgb = [f32; 3];
