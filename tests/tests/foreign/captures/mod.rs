//! Pictures, arrays and their sidecars as other programs write them.

mod arrays;
mod btf_images;
mod outputs;
mod pictures;
mod pictures_broken;
mod sidecars;
