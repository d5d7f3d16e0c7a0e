//! Techniques: the ways to draw scattering light and BTFs, each with its pipelines and what is bound to them.
//!
//! A technique implements [`pipelines::Pipelines`], and has its arms in [`drawable`] and in `Renderer::new`.

pub(crate) mod btf;
mod btf_query;
mod cascade;
pub(crate) mod common;
pub(crate) mod drawable;
pub(crate) mod gather;
pub(crate) mod mesh_pass;
mod patch;
pub(crate) mod pipelines;
pub(crate) mod separable;
pub(crate) mod splat;
pub(crate) mod tsm;

pub use btf::BtfOptions;
pub use btf_query::{BtfAnswer, BtfQueries, BtfQuery};
pub use drawable::{Drawable, Technique};
pub use patch::{
    Exitance, HomogeneousPatch, HomogeneousRenderer, PatchLight, PatchRenderer, Region, SeparablePatch,
    SeparableRenderer,
};
