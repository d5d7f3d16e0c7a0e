//! The C functions, from C and C++, in the library that apps link: values, misuse, hostile bytes, growth; and the header.
#![cfg(unix)]

mod compiler;
mod expected;
mod files;
mod header;
mod library;
mod programs;
mod symbols;
