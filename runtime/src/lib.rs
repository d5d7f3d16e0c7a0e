//! Draws `.subsurf` materials with wgpu, on Vulkan and on OpenGL ES 3.0.
//!
//! Everything keeps within `Limits::downlevel_webgl2_defaults()`: no compute, no storage buffers, tables in textures.

mod ambient;
mod btf;
mod cascade;
mod context;
mod error;
mod factors;
mod frame;
mod ledger;
mod material;
mod mesh;
mod pass;
mod patch;
mod pipeline;
mod resource;
mod separable;

pub use ambient::SkyShare;
pub use btf::{BtfAnswer, BtfImages, BtfMaterial, BtfQueries, BtfQuery};
pub use context::{Backend, Gpu, OnScreen, PictureTarget, devices};
pub use error::{Error, Result};
pub use factors::{SeparableMaterial, SplatMaterial};
pub use frame::{BACKGROUND, BtfOptions, Frame, GpuPoints, Model, Path, Plan, Renderer, RuntimeOptions};
pub use ledger::Ledger;
pub use material::{Material, storage_of};
pub use mesh::{GpuMesh, Known};
pub use patch::{Exitance, PatchLight, PatchRenderer, Region};
pub use separable::{HomogeneousPatch, HomogeneousRenderer, SeparablePatch, SeparableRenderer};
pub use subsurf_shaders::source::Keeping;
pub use subsurf_shaders::uniform::BtfFiltering;
pub use subsurf_shaders::{BtfStorage, Storage};
pub use wgpu;
