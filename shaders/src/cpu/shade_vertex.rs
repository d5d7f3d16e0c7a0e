//! Twin of `shade_vertex.wgsl`.

use glam::Vec3;
use subsurf_scene::MAX_LIGHTS;

use super::Reflections;
use super::raster::rasterise;
use super::shading::{Point, shaded};
use crate::rgb::Rgb;
use crate::uniform::Blocks;

/// Mesh with the exitance of its vertices.
#[derive(Clone, Copy, Debug)]
pub struct Triangles<'a> {
    /// Positions of the vertices in mm.
    pub positions: &'a [Vec3],
    /// Unit normals of the vertices.
    pub normals: &'a [Vec3],
    /// Exitance of the vertices, linear Rec. 709.
    pub exitances: &'a [Rgb],
    /// Visibility of each light from the vertices, 0 to 1.
    pub visibilities: &'a [[f32; MAX_LIGHTS]],
    /// Numbers of the vertices of the triangles.
    pub triangles: &'a [[u32; 3]],
}

/// Picture of a mesh in display values, `size` pixels, row by row from the top, in front of a `background`.
///
/// # Panics
/// If an index leads outside the vertices.
#[must_use]
pub fn shade_vertex(
    mesh: &Triangles<'_>,
    blocks: &Blocks,
    reflections: &Reflections<'_>,
    size: [u32; 2],
    background: [u8; 3],
) -> Vec<[u8; 3]> {
    let exitances: Vec<Vec3> = mesh.exitances.iter().map(|exitance| Vec3::from(*exitance)).collect();
    rasterise(mesh.positions, mesh.triangles, &blocks.scene.clip_from_world, size, background, |covered| {
        let point = Point {
            position_mm: covered.blend(mesh.positions),
            normal: covered.blend(mesh.normals),
            exitance: covered.blend(&exitances),
            visibility: covered.blend_all(mesh.visibilities),
        };
        shaded(blocks, reflections, &point)
    })
}
