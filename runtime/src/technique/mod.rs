//! The ways in which light scatters, each with its passes and what is bound to them.

pub(crate) mod btf;
mod btf_query;
mod cascade;
pub(crate) mod common;
pub(crate) mod gather;
pub(crate) mod light_views;
pub(crate) mod mesh_pass;
mod patch;
pub(crate) mod separable;
pub(crate) mod splat;

pub use btf::BtfOptions;
pub use btf_query::{BtfAnswer, BtfQueries, BtfQuery};
pub use patch::{
    Exitance, HomogeneousPatch, HomogeneousRenderer, PatchLight, PatchRenderer, Region, SeparablePatch,
    SeparableRenderer,
};
