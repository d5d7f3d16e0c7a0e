//! The passes on the CPU: the reference for the numbers of the GPU, and a renderer where there is no GPU.
//!
//! Each file is the twin of the pass, or of the library file, of the same name. Colours are linear Rec. 709. Where the GPU
//! stores a result in a half-float texture, the twin keeps f32.

mod blur_kernel;
mod coat;
mod fresnel;
#[cfg(feature = "gather")]
mod gather;
mod irradiance;
mod kernel_gbuffer;
mod patch_reduce;
mod present;
mod profile_sums;
mod raster;
mod scene;
mod shade_btf;
mod shade_kernel;
#[cfg(feature = "transfer")]
mod shade_transfer;
mod shade_vertex;
mod shading;
mod sum_kernel;
#[cfg(feature = "gather")]
mod surface_gather;
mod tone;

pub use blur_kernel::blur_kernel;
pub use coat::{Reflections, specular_ambient, specular_direct};
pub use fresnel::{diffuse_transmittance, fresnel_transmittance};
#[cfg(feature = "gather")]
pub use gather::{Reflectance, gather};
pub use irradiance::irradiance;
pub use kernel_gbuffer::{KernelGBuffer, KernelMesh, kernel_gbuffer};
pub use patch_reduce::patch_reduce;
pub use present::present;
pub use profile_sums::profile_sums;
pub use scene::{entering, incident, sky_irradiance};
pub use shade_btf::{BtfSurface, BtfTriangles, shade_btf};
pub use shade_kernel::shade_kernel;
#[cfg(feature = "transfer")]
pub use shade_transfer::{shade_transfer, transfer_exitance};
pub use shade_vertex::{Triangles, shade_vertex};
pub use sum_kernel::sum_kernel;
#[cfg(feature = "gather")]
pub use surface_gather::surface_gather;
pub use tone::{display, linear, neutral, srgb};
