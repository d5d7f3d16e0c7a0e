//! From a material and a mesh to a picture: computed, brought to a device, drawn.

mod btf;
mod exposure;
mod gpu;
mod mapping;
mod scattering;
mod session;
mod twin;

pub use btf::{BtfImageSet, expect_uvs, repeats, upload_images};
pub use exposure::{exposure_of, light_of};
pub use gpu::GpuAsset;
pub use mapping::{MappingChoice, choose_mapping};
pub use scattering::{Asset, Scattering, basis, numbers, points};
pub use session::RenderSession;
pub(crate) use session::chosen_exposure;
pub use twin::TexturedMesh;
