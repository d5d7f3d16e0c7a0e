//! How much of the light from all around leaves at a vertex.

/// Exitance of a vertex under uniform light from all around, relative to that of flat ground of the same material; rgb, 0 to
/// about 2.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AmbientTransfer {
    /// Share of the light that falls on the vertex's own side: surface around it counts by half of 1 + the cosine between both normals.
    pub front: [f32; 3],
    /// Share of the light on the other side, by the rest: what is round, and light that passes through thin parts.
    pub back: [f32; 3],
}

impl AmbientTransfer {
    /// Transfer of flat, open ground.
    pub const FLAT: Self = Self { front: [1.0; 3], back: [0.0; 3] };
}
