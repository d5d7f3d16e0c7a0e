//! Light volumes: wide Gaussians spread the light that enters in cells in space, where the eye does not have to see it.

mod bound;
mod grid;
mod passes;

pub(crate) use bound::Volume;
pub(crate) use passes::Passes;

/// Width and height of the maps that a volume takes in texels, a cell each.
pub(crate) const TEXELS: [u32; 2] = [256; 2];
