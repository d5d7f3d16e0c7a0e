//! Block of light volumes.

use bytemuck::{Pod, Zeroable};
use subsurf_scene::MAX_LIGHTS;

/// `Volume` of `volume.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct Volume {
    /// Projections of the lights' own views, inverted; column-major, depth 0 to 1.
    pub world_from_clip: [[[f32; 4]; 4]; MAX_LIGHTS],
    /// Middle of the first cell in mm.
    pub origin_mm: [f32; 3],
    /// Edge of a cell in mm.
    pub cell_mm: f32,
    /// Number of cells along x, y and z.
    pub cells: [i32; 3],
    /// Slices of equal z that lie in a row of the texture.
    pub columns: i32,
    /// Number of the first Gaussian that spreads in the volume; as many as there are, or more, if none does.
    pub first: u32,
    /// Number of the group whose light it is.
    pub group: f32,
    /// Pitch of the pixels of the material in mm.
    pub pitch_mm: f32,
    #[doc(hidden)]
    pub pad: u32,
}
