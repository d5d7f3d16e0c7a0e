//! The encoder of Havran, Filip and Myszkowski 2010, sections 4.1-4.5 and 5.1: nested codebooks by pruning.

mod codebooks;
mod encode;
mod functions;
mod halton;
mod index;
mod insert;
mod measure;
mod quantise;
mod rows;
mod similarity;

pub use encode::{Options, encode};
pub use similarity::{Allowed, Similarity};
