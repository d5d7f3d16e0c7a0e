//! Meshes on a device.

use std::mem::offset_of;

use glam::{Vec2, Vec3};
use subsurf_c::SubsurfStatus;
use subsurf_c::shared::{Handle, Kind, Versioned, fill, not_null, write};
use subsurf_runtime::{Error, GpuMesh, VertexData};
use subsurf_scene::{BoundingSphere, Mesh, bowl, drapery, knot, relief, sphere, torus};

use crate::fault::{Fault, Result, call};
use crate::gpu::{OpenGpu, SubsurfGpu, close};
use crate::input::{array, one_of, optional, take, within};

/// Shape that needs no file.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfShape {
    /// Sphere; u goes around, v from pole to pole.
    Sphere = 0,
    /// Ring.
    Torus = 1,
    /// Knot of a tube: thin and thick places close to each other.
    Knot = 2,
    /// Bowl with a wall to shine through.
    Bowl = 3,
    /// Cloth over a ball, in folds.
    Drapery = 4,
    /// Sphere with bumps and hollows.
    Relief = 5,
}

/// Triangle mesh on a device.
///
/// Ownership: `subsurf_mesh_*` give one, `subsurf_mesh_close` takes it back; it keeps its device.
/// Threads: any number at once, but for `subsurf_mesh_close`, which needs the handle for itself.
pub struct SubsurfMesh {
    /// What is there is a [`Handle`] of [`OpenMesh`].
    _opaque: [u8; 0],
}

/// Triangle mesh in memory. Set `struct_size` to `sizeof(SubsurfMeshData)`.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfMeshData {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Number of vertices.
    pub vertices: u32,
    /// Number of triangles, 1 to 1,431,655,765.
    pub triangles: u32,
    /// Millimetres to a unit of positions; 0 stands for 1.
    pub mm_per_unit: f32,
    /// Three numbers for each vertex, x, y up, z.
    pub positions: *const f32,
    /// Three numbers for each vertex, of any length; null, or zeros for a vertex, for the means of the triangles around.
    pub normals: *const f32,
    /// Two numbers for each vertex, u and v upwards; null where materials lie by a box. BTFs need them.
    pub uvs: *const f32,
    /// Three numbers of vertices for each triangle, counter-clockwise as seen from outside.
    pub indices: *const u32,
}

/// Description of a mesh. Set `struct_size` to `sizeof(SubsurfMeshInfo)` before it is filled.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfMeshInfo {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// Number of vertices.
    pub vertices: u32,
    /// Number of triangles.
    pub triangles: u32,
    /// Whether it has texture coordinates.
    pub has_uvs: u32,
    /// Middle of the box around it, in mm.
    pub centre_mm: [f32; 3],
    /// Distance of the furthest vertex from there, in mm.
    pub radius_mm: f32,
    /// Bytes on the device.
    pub gpu_bytes: u64,
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfMeshData {
    const NAME: &'static str = "SubsurfMeshData";
    const FIRST_BYTES: usize = offset_of!(Self, indices) + size_of::<*const u32>();
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfMeshInfo {
    const NAME: &'static str = "SubsurfMeshInfo";
    const FIRST_BYTES: usize = offset_of!(Self, gpu_bytes) + size_of::<u64>();
}

/// What is behind a handle.
pub(crate) struct OpenMesh {
    pub(crate) gpu: OpenGpu,
    pub(crate) mesh: GpuMesh,
    pub(crate) bounds: BoundingSphere,
    vertices: u32,
    triangles: u32,
    has_uvs: bool,
}

impl Kind for OpenMesh {
    const NAME: &'static str = "SubsurfMesh";
    const WORD: u64 = 0x5ab5_0f11_e0be_0005;
}

/// Most indices of a mesh: what a draw takes.
const MOST_TRIANGLES: u32 = u32::MAX / 3;
/// Largest radius of a mesh in mm, a kilometre: squares of lengths stay far from the end of single precision.
const MOST_MM: f32 = 1e6;

impl OpenMesh {
    /// The mesh behind a handle.
    ///
    /// # Safety
    /// As [`Handle::of`] says.
    pub(crate) unsafe fn of<'m>(mesh: *const SubsurfMesh) -> Result<&'m Self> {
        // SAFETY: the caller's word; what is there is such a handle.
        Ok(unsafe { Handle::<Self>::of("mesh", mesh.cast()) }?)
    }

    /// Uploads a mesh, with tangents where it has texture coordinates: BTFs need them.
    fn upload(gpu: &OpenGpu, mesh: &Mesh) -> Result<Self> {
        gpu.told(gpu.gpu.expect_alive())?;
        let bounds = mesh.bounding_sphere();
        let extent = bounds.centre_mm.abs().max_element() + bounds.radius_mm;
        if extent.is_nan() || extent > MOST_MM {
            let text = format!("the mesh reaches {extent} mm from its origin, expected are {MOST_MM} at most");
            return Err(Fault::Told(SubsurfStatus::InvalidMesh, text));
        }
        let tangents = if mesh.uvs.is_some() { Some(gpu.told(mesh.tangents().map_err(Error::Scene))?) } else { None };
        let known = VertexData { tangents: tangents.as_deref(), ..VertexData::default() };
        let number = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
        Ok(Self {
            gpu: gpu.clone(),
            mesh: gpu.told(GpuMesh::upload(&gpu.gpu, mesh, known))?,
            bounds,
            vertices: number(mesh.positions.len()),
            triangles: number(mesh.triangles.len()),
            has_uvs: mesh.uvs.is_some(),
        })
    }
}

/// Uploads what `make` gives.
///
/// # Safety
/// As [`Handle::of`] says, and `mesh_out` is null or leads to a pointer.
unsafe fn create(
    gpu: *const SubsurfGpu,
    mesh_out: *mut *mut SubsurfMesh,
    make: impl FnOnce() -> Result<Mesh>,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let gpu = unsafe { OpenGpu::of(gpu) }?;
        not_null("mesh_out", mesh_out)?;
        let handle = Handle::create(OpenMesh::upload(gpu, &make()?)?)?.as_ptr().cast();
        // SAFETY: the caller's pointer, which is not null.
        Ok(unsafe { write("mesh_out", mesh_out, handle) }?)
    })
}

/// Uploads a mesh.
///
/// `data`: the mesh. `*mesh_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT`, `INVALID_MESH` (no triangles, no area, an index outside, numbers that are not finite, more than 1 km),
/// `UNSUPPORTED` (more than a buffer of the device), `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
/// Ownership: the data is not needed afterwards.
/// Threads: any, also while another draws.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_mesh_upload(
    gpu: *const SubsurfGpu,
    data: *const SubsurfMeshData,
    mesh_out: *mut *mut SubsurfMesh,
) -> SubsurfStatus {
    let read = || {
        let null = std::ptr::null();
        let (positions, normals, uvs, indices) = (null, null, null, std::ptr::null());
        let usual = SubsurfMeshData {
            struct_size: 0,
            vertices: 0,
            triangles: 0,
            mm_per_unit: 0.0,
            positions,
            normals,
            uvs,
            indices,
        };
        // SAFETY: the caller's struct, of numbers and pointers.
        let data = unsafe { take("data", data, usual) }?;
        if data.triangles > MOST_TRIANGLES {
            return Err(Fault::invalid(format!("{} triangles, expected are {MOST_TRIANGLES} at most", data.triangles)));
        }
        let (vertices, triangles) = (data.vertices as usize, data.triangles as usize);
        // SAFETY: as many numbers as the struct says.
        let (positions, normals, uvs, indices) = unsafe {
            (
                array::<Vec3>("positions", data.positions.cast(), vertices)?,
                optional::<Vec3>("normals", data.normals.cast(), vertices)?.unwrap_or_default(),
                optional::<Vec2>("uvs", data.uvs.cast(), vertices)?,
                array::<[u32; 3]>("indices", data.indices.cast(), triangles)?,
            )
        };
        let mm_per_unit = if data.mm_per_unit == 0.0 { 1.0 } else { data.mm_per_unit };
        let mesh = Mesh::new(positions, normals, uvs, indices, mm_per_unit);
        let mesh = mesh.map_err(|error| Fault::of(&Error::Scene(error), None))?;
        Ok(if mesh.uvs.is_none() { mesh.charted() } else { mesh })
    };
    // SAFETY: the caller's handle and pointer.
    unsafe { create(gpu, mesh_out, read) }
}

/// Uploads a shape, around the origin, with texture coordinates.
///
/// `shape`: a `SubsurfShape`. `extent_mm`: its longest side, 0.001 to 1,000,000 mm. `*mesh_out`: the handle; only written on success.
/// Errors: `INVALID_ARGUMENT`, `OUT_OF_MEMORY`, `DEVICE_LOST`, `DEVICE_FAILED`.
/// Ownership: none besides the handle.
/// Threads: any, also while another draws.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_mesh_shape(
    gpu: *const SubsurfGpu,
    shape: u32,
    extent_mm: f32,
    mesh_out: *mut *mut SubsurfMesh,
) -> SubsurfStatus {
    let make = || {
        within("extent_mm", extent_mm, 1e-3..=MOST_MM)?;
        let makes: [fn() -> Mesh; 6] = [
            || sphere(1.0, 48),
            || torus(1.0, 0.45, 48),
            || knot(1.0, 0.3, 32),
            || bowl(1.0, 0.1, 40),
            || drapery(1.0, 0.06, 7, 48),
            || relief(1.0, 8, 80),
        ];
        let mesh = one_of("shape", shape, &makes)?();
        mesh.fitted(extent_mm).map_err(|error| Fault::of(&Error::Scene(error), None))
    };
    // SAFETY: the caller's handle and pointer.
    unsafe { create(gpu, mesh_out, make) }
}

/// What a mesh is.
///
/// `info`: filled as far as its `struct_size` reaches.
/// Errors: `INVALID_ARGUMENT`.
/// Ownership: the struct is the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_mesh_info(mesh: *const SubsurfMesh, info: *mut SubsurfMeshInfo) -> SubsurfStatus {
    call(|| {
        // SAFETY: the caller's handle.
        let open = unsafe { OpenMesh::of(mesh) }?;
        let value = SubsurfMeshInfo {
            struct_size: 0,
            vertices: open.vertices,
            triangles: open.triangles,
            has_uvs: open.has_uvs.into(),
            centre_mm: open.bounds.centre_mm.to_array(),
            radius_mm: open.bounds.radius_mm,
            gpu_bytes: open.mesh.gpu_bytes(),
        };
        // SAFETY: the caller's struct.
        Ok(unsafe { fill("info", info, value) }?)
    })
}

/// Closes a mesh. Null is ignored, and so is what is no handle.
///
/// Ownership: the handle is gone, and what is on the device once it is drawn.
/// Threads: any, once no other uses the handle.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_mesh_close(mesh: *mut SubsurfMesh) {
    close::<OpenMesh, _>(mesh);
}
