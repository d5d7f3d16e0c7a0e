//! Files of transfer.

mod format;
mod limits;
mod parts;
mod values;
