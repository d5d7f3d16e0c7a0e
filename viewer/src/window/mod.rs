//! The window: what is shown in it, and what keys, pointer and panel change.

mod app;
mod artist;
mod assets;
mod config;
mod controls;
mod draw;
mod event;
mod host;
mod job;
mod orbit;
mod panel;
mod session;
mod state;
mod times;
mod viewer;

pub use artist::{Artist, MakeKernel};
pub use config::{Config, LoadImages, options};
pub use controls::KEYS;
pub use event::Event;
pub use host::{Host, Picture};
pub use viewer::{Viewer, event_loop};
