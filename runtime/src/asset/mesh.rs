//! Meshes on the device, with what techniques need to know of every vertex.

use glam::{Vec2, Vec3, Vec4};
use subsurf_scene::{AmbientTransfer, BoundingSphere, Mesh};
use wgpu::{Buffer, BufferUsages, IndexFormat, RenderPass, VertexBufferLayout, VertexStepMode, vertex_attr_array};

use crate::error::{Error, Result};
use crate::gpu::{Gpu, Purpose, Tracked};

/// Mesh on the device.
#[derive(Debug)]
pub struct GpuMesh {
    vertices: Tracked<Buffer>,
    indices: Tracked<Buffer>,
    /// Tangents, of a mesh for BTFs.
    tangents: Option<Tracked<Buffer>>,
    index_count: u32,
    /// One more than the largest point that a vertex names; 0 if none does.
    pub(crate) points: usize,
    has_uvs: bool,
    /// CRC-32 of positions and of triangles, [`Mesh::geometry_crc`].
    #[cfg(feature = "transfer")]
    pub(crate) geometry_crc: [u32; 2],
    /// Where the mesh is, in its own space.
    pub(crate) bounds: BoundingSphere,
    /// Lowest and highest corner of the box around it, in its own space.
    pub(crate) corners: [Vec3; 2],
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct Vertex {
    position_mm: Vec3,
    normal: Vec3,
    /// Texture coordinates of the mesh, v up.
    uv: Vec2,
    point: u32,
    /// [`AmbientTransfer::front`], 0 to 2 as 0 to 255.
    sky_front: [u8; 4],
    /// [`AmbientTransfer::back`], likewise.
    sky_back: [u8; 4],
    /// Shares of the sides of the box.
    sides: [i8; 4],
}

/// What techniques need to know of every vertex, in the order of the mesh; what nobody needs may be left out.
#[derive(Clone, Copy, Debug, Default)]
pub struct VertexData<'a> {
    /// Number of the vertex's point, [`subsurf_scene::SurfacePoints::point_of`]: for the gather.
    pub points: Option<&'a [u32]>,
    /// Light from all around that scatters to the vertex, computed ahead of time for the size that the mesh is
    /// drawn in: for splats and separable blurs, where it is that of flat, open ground without it.
    pub ambient: Option<&'a [AmbientTransfer]>,
    /// Tangents, [`Mesh::tangents`]: for BTFs.
    pub tangents: Option<&'a [Vec4]>,
}

/// Values of 0 to 2 as bytes of 0 to 255.
fn halves(share: [f32; 3]) -> [u8; 4] {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let [r, g, b] = share.map(|value| (value * 127.5).round().clamp(0.0, 255.0) as u8);
    [r, g, b, 0]
}

impl GpuMesh {
    /// Uploads a mesh with data of its vertices.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the device takes no buffers of that size; [`Error::Mesh`] if there are more than 2³² indices;
    /// [`Error::Usage`] if there is data for another number of vertices than the mesh has.
    pub fn upload(gpu: &Gpu, mesh: &Mesh, known: VertexData<'_>) -> Result<Self> {
        let count = mesh.positions.len();
        let lengths = [known.points.map(<[_]>::len), known.ambient.map(<[_]>::len), known.tangents.map(<[_]>::len)];
        if let Some(length) = lengths.into_iter().flatten().find(|length| *length != count) {
            return Err(Error::Usage(format!("data of {length} vertices for a mesh of {count}")));
        }
        let sides = mesh.sides();
        let vertex = |k: usize| {
            let sky = known.ambient.map_or(AmbientTransfer::FLAT, |sky| sky[k]);
            Vertex {
                position_mm: mesh.positions[k],
                normal: mesh.normals[k],
                uv: mesh.uvs.as_ref().map_or(Vec2::ZERO, |uvs| uvs[k]),
                point: known.points.map_or(0, |points| points[k]),
                sky_front: halves(sky.front),
                sky_back: halves(sky.back),
                sides: sides[k].0,
            }
        };
        let vertices: Vec<Vertex> = (0..count).map(vertex).collect();
        let limit = gpu.device.limits().max_buffer_size;
        let need = (size_of_val(&vertices[..]) as u64).max(size_of_val(&mesh.triangles[..]) as u64);
        if need > limit {
            return Err(Error::Unsupported { what: "buffers", need, have: limit });
        }
        let index_count = u32::try_from(3 * mesh.triangles.len());
        let tangents =
            |tangents| gpu.buffer(Purpose::Mesh, "tangents", bytemuck::cast_slice(tangents), BufferUsages::VERTEX);
        Ok(Self {
            vertices: gpu.buffer(Purpose::Mesh, "vertices", bytemuck::cast_slice(&vertices), BufferUsages::VERTEX),
            indices: gpu.buffer(Purpose::Mesh, "indices", bytemuck::cast_slice(&mesh.triangles), BufferUsages::INDEX),
            tangents: known.tangents.map(tangents),
            index_count: index_count.map_err(|_| Error::Mesh("more than 2³² indices".to_owned()))?,
            points: known.points.into_iter().flatten().max().map_or(0, |largest| *largest as usize + 1),
            has_uvs: mesh.uvs.is_some(),
            #[cfg(feature = "transfer")]
            geometry_crc: mesh.geometry_crc(),
            bounds: mesh.bounding_sphere(),
            corners: mesh.bounds(),
        })
    }

    /// Refuses a mesh that was uploaded without texture coordinates.
    pub(crate) fn expect_uvs(&self) -> Result<()> {
        let missing = || Error::Mesh("it has no texture coordinates, by which the material lies on it".to_owned());
        self.has_uvs.then_some(()).ok_or_else(missing)
    }

    /// Refuses a mesh that was uploaded without tangents.
    pub(crate) fn expect_tangents(&self) -> Result<()> {
        let missing = || Error::Mesh("uploaded without tangents, which a BTF needs".to_owned());
        self.tangents.as_ref().map(|_| ()).ok_or_else(missing)
    }

    /// Draws all triangles in a pass that was begun with their shader.
    pub(crate) fn draw(&self, pass: &mut RenderPass<'_>) {
        pass.set_vertex_buffer(0, self.vertices.slice(..));
        if let Some(tangents) = &self.tangents {
            pass.set_vertex_buffer(1, tangents.slice(..));
        }
        pass.set_index_buffer(self.indices.slice(..), IndexFormat::Uint32);
        pass.draw_indexed(0..self.index_count, 0, 0..1);
    }

    /// Bytes of vertices and indices on the device.
    #[must_use]
    pub fn gpu_bytes(&self) -> u64 {
        let tangents = self.tangents.as_ref().map_or(0, Tracked::bytes);
        self.vertices.bytes() + self.indices.bytes() + tangents
    }
}

pub(crate) const VERTICES: VertexBufferLayout<'static> = VertexBufferLayout {
    array_stride: size_of::<Vertex>() as u64,
    step_mode: VertexStepMode::Vertex,
    attributes: &vertex_attr_array![
        0 => Float32x3, 1 => Float32x3, 2 => Float32x2, 3 => Uint32, 4 => Unorm8x4, 5 => Unorm8x4,
        7 => Snorm8x4
    ],
};

pub(crate) const TANGENTS: VertexBufferLayout<'static> = VertexBufferLayout {
    array_stride: size_of::<Vec4>() as u64,
    step_mode: VertexStepMode::Vertex,
    attributes: &vertex_attr_array![6 => Float32x4],
};
