//! Files of BTFs, nested and factored.

mod codebook_offsets;
#[cfg(feature = "alloc")]
mod factored;
mod integers;
mod nested_limits;
mod nested_values;
mod sampler;
#[cfg(feature = "alloc")]
mod vectors;
