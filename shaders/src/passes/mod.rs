//! The passes: which WGSL files each is joined from, its entry points, its bindings.
//!
//! [`table`] has a row for each file under `wgsl/pass/`. A row may leave open how the material, the intermediate targets and so
//! on are stored; a [`Variant`] has chosen.

mod binding;
mod file;
mod layout;
mod pass;
pub mod table;

pub use binding::Binding;
pub use file::File;
pub use layout::{BtfLayout, MaterialLayout, TargetFormat};
pub use pass::{Choice, Group, Part, Pass, Variant};
