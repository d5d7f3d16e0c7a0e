//! Meshes as the CPU twin of the BTF shaders reads them.

use glam::{Vec2, Vec4};
use subsurf_scene::{MAX_LIGHTS, Mesh};
use subsurf_shaders::cpu;

use crate::error::Result;

/// Texture coordinates and tangents of a mesh, for the CPU twin of the BTF shaders.
pub struct TexturedMesh {
    uvs: Vec<Vec2>,
    tangents: Vec<Vec4>,
}

impl TexturedMesh {
    /// For so many copies of a material along u and v.
    ///
    /// # Errors
    /// The mesh has no texture coordinates.
    pub fn new(mesh: &Mesh, repeats: [f32; 2]) -> Result<Self> {
        let down = |uv: &Vec2| Vec2::new(uv.x * repeats[0], 1.0 - uv.y * repeats[1]);
        Ok(Self { uvs: mesh.uvs.iter().flatten().map(down).collect(), tangents: mesh.tangents()? })
    }

    /// Triangles for [`cpu::shade_btf`]; `visibilities` say what every vertex sees of every light, 0 to 1.
    #[must_use]
    pub fn triangles<'a>(&'a self, mesh: &'a Mesh, visibilities: &'a [[f32; MAX_LIGHTS]]) -> cpu::BtfTriangles<'a> {
        cpu::BtfTriangles {
            positions: &mesh.positions,
            normals: &mesh.normals,
            uvs: &self.uvs,
            tangents: &self.tangents,
            visibilities,
            triangles: &mesh.triangles,
        }
    }
}
