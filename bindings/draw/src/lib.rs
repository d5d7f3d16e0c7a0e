//! C functions around the renderer: what `bindings/include/subsurf.h` declares of devices, materials, meshes, pictures and surfaces.
//!
//! Handles, statuses and texts are those of [`subsurf_c`]. Everything from a caller is checked before the renderer sees it; a panic
//! of what lies below, where panics unwind, is a status.
#![deny(unsafe_op_in_unsafe_fn)]

mod canvas;
mod environment;
mod fault;
mod frame;
mod gpu;
mod input;
mod material;
mod mesh;
mod picture;
mod renderer;
mod surface;
mod window;

pub use environment::{
    SubsurfEnvironment, subsurf_environment_close, subsurf_environment_picture, subsurf_environment_studio,
    subsurf_environment_uniform,
};
pub use frame::{SubsurfFrame, SubsurfLight, SubsurfLightKind, SubsurfMapping, SubsurfObject, subsurf_frame_look_at};
pub use gpu::{
    SubsurfBackend, SubsurfGpu, SubsurfGpuInfo, SubsurfGpuMemory, SubsurfGpuOptions, subsurf_gpu_close,
    subsurf_gpu_finish, subsurf_gpu_info, subsurf_gpu_lose, subsurf_gpu_memory, subsurf_gpu_open,
};
pub use material::{
    SubsurfLoadReport, SubsurfMaterial, SubsurfMaterialInfo, SubsurfMaterialOptions, SubsurfTechnique,
    subsurf_material_close, subsurf_material_info, subsurf_material_load,
};
pub use mesh::{
    SubsurfMesh, SubsurfMeshData, SubsurfMeshInfo, SubsurfShape, subsurf_mesh_close, subsurf_mesh_info,
    subsurf_mesh_shape, subsurf_mesh_upload,
};
pub use picture::{SubsurfPicture, subsurf_picture_close, subsurf_picture_create, subsurf_picture_read};
pub use renderer::{
    SubsurfFrameReport, SubsurfRenderer, SubsurfRendererOptions, subsurf_renderer_close, subsurf_renderer_create,
    subsurf_renderer_draw_picture, subsurf_renderer_draw_surface, subsurf_renderer_trim,
};
pub use surface::{SubsurfSurface, subsurf_surface_close, subsurf_surface_open, subsurf_surface_resize};

pub use window::SubsurfWindowSystem;
