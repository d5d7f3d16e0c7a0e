//! Techniques: the ways to draw scattering light and BTFs, each with its pipelines and what is bound to them.
//!
//! A technique implements [`bindings::Bindings`]; `frame/renderer.rs` compiles it, and `frame/prepare.rs` binds its materials.

mod area;
mod bindings;
pub(crate) mod btf;
mod btf_query;
mod cascade;
mod common;
pub(crate) mod gather;
mod host_shadow;
pub(crate) mod kernel;
mod kind;
#[cfg(feature = "reference")]
pub(crate) mod linsss;
mod mesh_pass;
mod patch;
pub(crate) mod separable;
pub(crate) mod splat;
#[cfg(feature = "transfer")]
pub(crate) mod transfer;
mod tsm;
pub(crate) mod volume;

pub(crate) use area::MapArea;
pub(crate) use bindings::{Bindings, Group, Lap, group_number};
pub use btf::BtfOptions;
pub use btf_query::{BtfAnswer, BtfQueries, BtfQuery};
pub(crate) use cascade::{CascadeMaps, Maps};
pub(crate) use common::{Common, reflection_sampler};
pub use kind::Technique;
pub use mesh_pass::DepthFormat;
pub(crate) use mesh_pass::{Attachments, Viewport};
#[cfg(feature = "reference")]
pub use patch::KernelScreen;
pub(crate) use patch::PatchCascade;
pub use patch::{
    Exitance, HomogeneousPatch, HomogeneousRenderer, PatchLight, PatchRenderer, Region, SeparablePatch,
    SeparableRenderer,
};
pub use splat::SplatLevels;
pub(crate) use tsm::{TranslucentShadowMaps, TsmPasses};
