//! From files and meshes to what is on the device, one file for each kind.

mod bssrdf;
mod btf;
mod btf_images;
mod kernel;
#[cfg(feature = "reference")]
mod linsss;
mod material;
mod mesh;
mod patch_layers;
mod points;
mod separable;
mod splat;
#[cfg(feature = "transfer")]
mod transfer;

pub use bssrdf::{BssrdfPlanes, layout_of};
pub use btf::BtfMaterial;
pub use btf_images::BtfImages;
pub use kernel::KernelMaterial;
#[cfg(feature = "reference")]
pub use linsss::{LinsssMaterial, LinsssModel};
pub use material::{GatherMaterial, Material};
pub use mesh::{GpuMesh, VertexData};
pub(crate) use mesh::{TANGENTS, VERTICES};
pub(crate) use patch_layers::PatchLayers;
pub use points::GpuPoints;
pub(crate) use points::{LitBy, tiled_size};
pub use separable::SeparableMaterial;
pub use splat::SplatMaterial;
#[cfg(feature = "transfer")]
pub use transfer::TransferMaterial;
