//! The passes: which WGSL files each is joined from, its entry points, its bindings.
//!
//! [`table`] has a row for each file under `wgsl/pass/`, but for those of separable kernels, in [`kernel`], of light volumes, in
//! [`volume`], of what is precomputed for vertices, in [`transfer`], and of a rival, in [`linsss`]. A row may leave open how the material,
//! the intermediate targets and so on are stored; a [`Variant`] has chosen.

mod all;
mod binding;
mod file;
pub mod kernel;
mod layout;
pub mod linsss;
mod pass;
pub mod table;
pub mod transfer;
pub mod volume;

pub use all::ALL;
pub use binding::Binding;
pub use file::File;
pub use layout::{BtfLayout, MaterialLayout, TargetFormat};
pub use pass::{Choice, Group, Part, Pass, Variant};
