//! Pictures, arrays and their sidecars as other programs write them.

mod pictures;
mod pictures_broken;
