//! Entry points of the Kotlin API, the `external` functions of `dev.subsurf.Native`.
//!
//! Each converts Java's arguments, calls one function of `subsurf.h`, and returns its status. What a function finds is written to
//! arrays of the caller's. Nothing is thrown and no class is looked up here: Kotlin makes exceptions of statuses, so that shrinkers may
//! rename all but the names of these functions. Handles travel as `long`; Kotlin sees to it that they are open.
//!
//! All that is unsafe has one reason: the virtual machine passes a valid environment, and objects of the types that
//! `Native.kt` declares; handles are pointers that these functions gave.
#![deny(
    clippy::arithmetic_side_effects,
    clippy::indexing_slicing,
    clippy::unwrap_used,
    clippy::expect_used,
    clippy::panic,
    unsafe_op_in_unsafe_fn
)]
#![allow(non_snake_case, reason = "names are those that virtual machines look for")]

mod bssrdf;
mod btf;
mod convert;
mod env;
mod file;
mod frame;
mod gpu;
mod material;
mod renderer;
mod surface;
