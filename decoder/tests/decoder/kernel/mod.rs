//! Files of kernels.

mod format;
mod limits;
