//! Draws `.subsurf` materials with wgpu, on Vulkan and on OpenGL ES 3.0.
//!
//! Everything keeps within `Limits::downlevel_webgl2_defaults()`: no compute, no storage buffers, tables in textures.

mod asset;
mod error;
mod frame;
mod gpu;
mod load;
mod technique;

#[cfg(feature = "transfer")]
pub use asset::TransferMaterial;
pub use asset::{
    BssrdfPlanes, BtfImages, BtfMaterial, GatherMaterial, GpuMesh, GpuPoints, KernelMaterial, Material,
    SeparableMaterial, SplatMaterial, VertexData, layout_of,
};
#[cfg(feature = "reference")]
pub use asset::{LinsssMaterial, LinsssModel};
pub use error::{Error, Result};
pub use frame::{
    BACKGROUND, BACKGROUND_COLOUR, DepthTarget, Frame, Input, Object, PassTimes, PictureTarget, Plan, Renderer,
    RuntimeOptions, ShadowMap, Target,
};
pub use gpu::{Backend, ColourTarget, Gpu, Ledger, OffScreen, OnScreen, Purpose, Screen, devices};
pub use load::{Load, LoadPhase, LoadTimer, LoadTimes, RawImages, Stored};
pub use subsurf_shaders::uniform::BtfFiltering;
pub use subsurf_shaders::{BtfLayout, MaterialLayout, TargetFormat};
#[cfg(feature = "reference")]
pub use technique::KernelScreen;
pub use technique::{
    BtfAnswer, BtfOptions, BtfQueries, BtfQuery, DepthFormat, Exitance, HomogeneousPatch, HomogeneousRenderer,
    PatchLight, PatchRenderer, Region, SeparablePatch, SeparableRenderer, SplatLevels, Technique,
};
pub use wgpu;
