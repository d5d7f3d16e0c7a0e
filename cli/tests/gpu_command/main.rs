//! The commands as their users call them.

mod arguments;
mod bssrdf;
mod btf;
mod captures;
mod common;
mod inputs_captures;
mod inputs_materials;
mod inputs_meshes;
mod interrupt;
mod metadata;
mod render;
mod transfer;
#[cfg(target_os = "linux")]
mod view;
