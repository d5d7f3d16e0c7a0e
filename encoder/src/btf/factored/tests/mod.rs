//! Files from random factors, and from images.

mod file;
mod images;
