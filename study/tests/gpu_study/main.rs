//! The program's commands, at the size of a stamp.

mod bench;
mod bssrdf;
mod btf;
mod common;
mod kernel;
mod linsss;
mod mesh;
