//! A BTF as a folder of images, one for each pair of directions.

mod listing;
mod read;
mod source;
mod write;

pub use read::Folder;
pub use write::{FolderWriter, Pixels};
