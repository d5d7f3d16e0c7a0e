//! Files of transfer.

mod format;
mod limits;
