//! Twin of `kernel_gbuffer.wgsl`, for lights that shine through everything.

use glam::{Vec3, Vec4};

use super::raster::rasterise;
use super::{entering, incident};
use crate::uniform::Blocks;

/// Mesh of a homogeneous material.
#[derive(Clone, Copy, Debug)]
pub struct KernelMesh<'a> {
    /// Positions of the vertices in mm.
    pub positions: &'a [Vec3],
    /// Unit normals of the vertices.
    pub normals: &'a [Vec3],
    /// Numbers of the vertices of the triangles.
    pub triangles: &'a [[u32; 3]],
}

/// What the eye sees of a mesh.
#[derive(Clone, Debug)]
pub struct KernelGBuffer {
    /// Light that enters, linear Rec. 709, and depth in mm from the middle of the scene; row by row from the top.
    pub entered: Vec<Vec4>,
    /// Positions in mm and unit normals, where there is a surface.
    pub points: Vec<Option<[Vec3; 2]>>,
}

/// Light that enters where the eye sees a mesh, in a picture of `size` pixels; nothing is in shadow, nothing is transmitted.
///
/// # Panics
/// If an index leads outside the vertices.
#[must_use]
pub fn kernel_gbuffer(mesh: &KernelMesh<'_>, blocks: &Blocks, size: [u32; 2]) -> KernelGBuffer {
    let scene = &blocks.scene;
    let pixels = size.map(|side| side as usize).iter().product();
    let mut found =
        KernelGBuffer { entered: vec![Vec4::new(0.0, 0.0, 0.0, 60_000.0); pixels], points: vec![None; pixels] };
    rasterise(mesh.positions, mesh.triangles, &scene.clip_from_world, size, [0; 3], |covered| {
        let [position_mm, normal] = [covered.blend(mesh.positions), covered.blend(mesh.normals).normalize()];
        let depth = (position_mm - Vec3::from(scene.centre_mm)).dot(scene.forward.into());
        let lights = (0..scene.lights as usize).map(|light| {
            let (towards, irradiance) = incident(scene, light, position_mm);
            irradiance * entering(&blocks.object, normal, towards)
        });
        let at = (covered.pixel[1] * size[0] + covered.pixel[0]) as usize;
        found.entered[at] = lights.sum::<Vec3>().extend(depth + blocks.object.depth_offset_mm);
        found.points[at] = Some([position_mm, normal]);
        [0; 3]
    });
    found
}
