//! Techniques by name.

use subsurf_shaders::{BtfLayout, MaterialLayout};

/// Technique by which a material is drawn, with what its pipelines depend on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Technique {
    /// Gather: every vertex sums the light of all others within reach. The reference, and slow.
    Gather(MaterialLayout),
    /// Multiresolution splats: every sample that a light sees is spread over what lies around it.
    Splat(MaterialLayout),
    /// Separable blurs on the screen, of L weighted irradiance maps by shared Gaussians; L is 1 or 2.
    Separable(usize),
    /// LinSSS, a rival: blurs of light and of weighted light, or its authors' shortcut.
    #[cfg(feature = "reference")]
    Linsss,
    /// BTF: light leaves where it enters, as the texture function says; nothing scatters between pixels.
    Btf(BtfLayout),
    /// Separable kernel of a homogeneous material, blurred on the screen, two passes for each of its terms.
    Kernel,
    /// Scattering precomputed for the vertices of one mesh; no passes of its own.
    #[cfg(feature = "transfer")]
    Transfer,
}
