//! The device: what lives on it, how passes are compiled and begun.

mod backend;
mod blocks;
mod cache;
mod device;
mod fill;
mod layout;
mod ledger;
mod pass;
mod pipeline;
mod read;
mod resource;
mod screen;

pub use backend::{Backend, devices};
pub(crate) use blocks::{BLOCK_STRIDE, Blocks};
pub(crate) use cache::Pipeline;
pub(crate) use device::TIMESTAMPS;
pub use device::{Gpu, OffScreen, OnScreen};
pub(crate) use fill::{Fill, PIECE_BYTES};
pub(crate) use ledger::Tracked;
pub use ledger::{Ledger, Purpose};
pub(crate) use pass::{FullscreenPass, QuadPass, Rows};
pub(crate) use pipeline::{Drawing, Program, attachment, bind, bind_group_layout};
pub use read::ColourTarget;
pub(crate) use resource::{DEPTH, HALF, Surface2d, TextureSpec, array_size, layer_of, layers_of, level_of};
pub use screen::Screen;
