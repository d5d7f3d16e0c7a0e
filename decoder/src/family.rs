//! Families of files: what a `.subsurf` file can hold.

use core::fmt;

/// Family of a file, which says what type reads it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Family {
    /// Diffuse BSSRDF of a patch, read by [`Bssrdf`](crate::Bssrdf).
    Bssrdf,
    /// Bidirectional texture functions in nested codebooks, read by [`NestedBtf`](crate::NestedBtf).
    NestedBtf,
    /// Bidirectional texture functions as a Tucker decomposition, read by [`FactoredBtf`](crate::FactoredBtf).
    FactoredBtf,
    /// Diffusion profile and separable kernel of a homogeneous material, read by [`Kernel`](crate::Kernel).
    Kernel,
    /// Scattering precomputed for the vertices of a mesh, read by [`Transfer`](crate::Transfer).
    #[cfg(feature = "transfer")]
    Transfer,
}

impl fmt::Display for Family {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bssrdf => "BSSRDF",
            Self::NestedBtf => "nested BTF",
            Self::FactoredBtf => "factored BTF",
            Self::Kernel => "kernel",
            #[cfg(feature = "transfer")]
            Self::Transfer => "transfer",
        })
    }
}
