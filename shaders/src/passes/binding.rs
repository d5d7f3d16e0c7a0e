//! Kinds of resources that passes read.

/// Kind of a resource in a bind group; all are seen by both stages.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Binding {
    /// Uniform block.
    Uniform,
    /// Uniform block of one of many objects, at an offset that is set when it is drawn.
    Object,
    /// Float texture that is loaded and never filtered.
    Float,
    /// Array of float textures that are loaded and never filtered.
    FloatLayers,
    /// Intermediate target of an earlier pass, in the [`TargetFormat`](super::TargetFormat).
    Target,
    /// Array of intermediate targets.
    TargetLayers,
    /// Float texture that is filtered.
    Filtered,
    /// Array of float textures that are filtered.
    FilteredLayers,
    /// Sampler that filters.
    Sampler,
    /// Sampler that does not filter, for its way to address texels beyond the border.
    Nearest,
    /// Unsigned integer texture.
    Uint,
    /// Array of unsigned integer textures.
    UintLayers,
}

impl Binding {
    /// The same with one layer in place of an array of maps.
    pub(super) fn plain(self) -> Self {
        match self {
            Self::TargetLayers => Self::Target,
            other => other,
        }
    }
}
