//! Scattering precomputed for every vertex of a mesh (Hao and Varshney 2004, *Real-time rendering of translucent meshes*).
//!
//! [`precompute`] adds up, for a set of directions of light, what leaves a homogeneous material at each vertex: q. Sections and
//! equations are those of the paper. [`encode`] compresses it to a file of a few bytes per vertex.

mod compress;
mod gather;
mod irradiance;
mod lights;
mod near;
mod point_tree;
mod precompute;
mod rd_table;
mod scheme;
mod surface;
mod write;

pub use compress::Size;
pub use lights::fibonacci;
pub use precompute::{Options, Precomputed, precompute};
pub use rd_table::RdTable;
pub use scheme::Scheme;
pub use write::{encode, file_bytes};
