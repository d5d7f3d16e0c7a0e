//! Diffuse BSSRDFs: captures to files of per-pixel profiles and of K-BMPP.

pub mod basis;
pub(crate) mod clusters;
pub(crate) mod direct;
mod encode;
pub(crate) mod field;
mod homogeneous;
mod limits;
pub(crate) mod model;
pub(crate) mod normal;
pub(crate) mod options;
pub(crate) mod profiles;
pub(crate) mod window;
pub(crate) mod write;

pub use encode::{Encoded, Problem, encode};
pub use homogeneous::{HomogeneousPatch, homogeneous};
pub use limits::{base_materials_within, file_bytes, fit_bytes};
pub use options::{Method, Options};
pub use write::{mixtures, profiles, write_file};
