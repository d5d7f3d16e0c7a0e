//! A BTF as a folder of images, one for each pair of directions.

mod read;
mod write;

pub use read::Folder;
pub use write::{FolderWriter, Pixels};
