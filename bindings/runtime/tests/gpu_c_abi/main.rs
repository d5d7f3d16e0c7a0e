//! The C functions of the renderer, from C and C++, in the library that apps link: pictures, mistakes, lost devices, windows, growth.
#![cfg(target_os = "linux")]

#[path = "../../../c/tests/abi/compiler.rs"]
mod compiler;
#[path = "../../../c/tests/abi/header.rs"]
mod header;
mod pictures;
mod programs;
mod symbols;
