//! What the window draws on the device: pictures, the panel over them, and the surface that shows both.

mod compose;
mod painter;
mod stage;
mod surface;

pub(super) use compose::Shows;
pub(super) use painter::Overlay;
pub(super) use stage::{Role, Stage};
