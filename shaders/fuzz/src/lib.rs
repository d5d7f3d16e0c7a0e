//! What is drawn of a hostile file on the CPU, each family by its twins.

mod bssrdf;
mod btf;
mod kernel;
mod stage;
mod transfer;

pub use bssrdf::bssrdf;
pub use btf::nested_btf;
pub use kernel::kernel;
pub use transfer::transfer;

/// Whether values are numbers, none infinite.
fn are_finite<'a>(values: impl IntoIterator<Item = &'a [f32; 3]>) -> bool {
    values.into_iter().flatten().all(|value| value.is_finite())
}
