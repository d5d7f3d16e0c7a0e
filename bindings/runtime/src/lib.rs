//! `libsubsurf.so`: all functions of `subsurf.h`, the renderer included, and the entry points of the Kotlin API.

// Functions that it exports: a line for each crate of them.
use subsurf_c as _;
use subsurf_c_draw as _;
use subsurf_jni as _;
