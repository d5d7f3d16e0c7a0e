//! The decoder as its users see it, by families of files. One program, since a linker's time is spent on each.

mod bssrdf;
mod btf;
mod common;
mod container;
mod kernel;
#[cfg(feature = "push")]
mod push;
#[cfg(feature = "transfer")]
mod transfer;
