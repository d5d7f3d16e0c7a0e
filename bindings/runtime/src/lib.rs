//! `libsubsurf.so`: all functions of `subsurf.h`, the renderer included.

// Functions that it exports: a line for each crate of them.
use subsurf_c as _;
use subsurf_c_draw as _;
