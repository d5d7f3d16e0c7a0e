//! Block of what is precomputed for the vertices of a mesh.

use bytemuck::{Pod, Zeroable};

/// Most components of a vertex.
const COMPONENTS: usize = 16;

/// `Transfer` of `transfer_vertex.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Transfer {
    /// Bits and mask of the coefficient of each component.
    pub codes: [[u32; 4]; COMPONENTS],
    /// Number of components, 1 to 16.
    pub components: u32,
    /// Texels of a vertex, 1 or 2.
    pub texels: u32,
    #[doc(hidden)]
    pub pad: [u32; 2],
}

impl Transfer {
    /// Block for coefficients of so many bits, 1 to 12 each and zeros after the last, in so many texels to a vertex.
    #[must_use]
    pub fn new(bits: &[u8; COMPONENTS], texels: u32) -> Self {
        let codes = bits.map(|bits| [bits.into(), (1 << bits) - 1, 0, 0]);
        let components = codes.iter().take_while(|[bits, ..]| *bits > 0).map(|_| 1).sum();
        Self { codes, components, texels, pad: [0; 2] }
    }
}
