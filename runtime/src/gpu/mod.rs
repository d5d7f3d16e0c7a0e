//! The device: what lives on it, how passes are compiled and begun.

mod backend;
mod device;
mod ledger;
mod pass;
mod pipeline;
mod read;
mod resource;
mod slot;

pub use backend::{Backend, devices};
pub use device::{Gpu, OnScreen};
pub use ledger::Ledger;
pub(crate) use ledger::Tracked;
pub(crate) use pass::{CoverPass, Rows, SquarePass};
pub(crate) use pipeline::{Drawing, Pipeline, Program, attachment};
pub use read::PictureTarget;
pub(crate) use resource::{
    DEPTH, HALF, Surface2d, TextureSpec, array_size, layer_of, layers_of, layers_of_level, level_of,
};
pub(crate) use slot::Slot;
