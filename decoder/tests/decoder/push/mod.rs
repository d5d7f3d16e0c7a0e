//! Readers of pushed bytes.

mod microcontroller;
#[cfg(feature = "transfer")]
mod refused;
#[cfg(feature = "transfer")]
mod rows;
#[cfg(feature = "transfer")]
mod widest;
