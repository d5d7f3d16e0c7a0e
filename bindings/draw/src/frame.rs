//! What a frame shows, as callers say it, and as the renderer takes it.

use std::mem::offset_of;

use glam::camera::rh::proj::directx::perspective;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use subsurf_c::SubsurfStatus;
use subsurf_c::shared::{Versioned, fill, read3};
use subsurf_runtime::{Material, Object};
use subsurf_scene::{Light, LightShape, MAX_LIGHTS, Mapping, Shadow, View};

use crate::environment::{OpenEnvironment, SubsurfEnvironment};
use crate::fault::{Fault, Result, call};
use crate::gpu::OpenGpu;
use crate::input::{Structs, finite, one_of, take, within};
use crate::material::{OpenMaterial, SubsurfMaterial};
use crate::mesh::{OpenMesh, SubsurfMesh};

/// Kind of a light.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfLightKind {
    /// From afar: `place` is the direction towards it, of any length but 0.
    Directional = 0,
    /// From a point, all around: what it lights should be within 75 degrees of the direction to the middle of the objects.
    Point = 1,
    /// From a point into a cone around the line to `target_mm`, which fades over its outer tenth.
    Spot = 2,
}

/// Rule by which a material lies on a mesh.
#[repr(u32)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SubsurfMapping {
    /// Texture coordinates: the unit square of them shows `copies` of the material in u and in v.
    Uv = 0,
    /// In its own size, from the side of a box that each normal faces most; not for BTFs, which have no size.
    Box = 1,
}

/// Source of light.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfLight {
    /// A `SubsurfLightKind`.
    pub kind: u32,
    /// Whether objects cast shadows of it, which takes 4 MiB on the device at the usual size.
    pub has_shadow: u32,
    /// Direction towards it, or its position in mm.
    pub place: [f32; 3],
    /// Point on the axis of a spot light, in mm.
    pub target_mm: [f32; 3],
    /// Angle from the axis of a spot light to the side of its cone in rad, to 75 degrees.
    pub half_angle_rad: f32,
    /// Irradiance on a plane that faces it, R, G, B of linear Rec. 709, 0 to 1e30: anywhere from afar, at `reference_mm` of the frame from
    /// nearby, where it falls with the square of the distance.
    pub irradiance: [f32; 3],
}

/// Object: a mesh, what it is made of, and where it is. Objects of one material scatter light between each other.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfObject {
    /// Mesh.
    pub mesh: *const SubsurfMesh,
    /// Material.
    pub material: *const SubsurfMaterial,
    /// Number of the material of a BTF, from 0, below `SubsurfMaterialInfo::materials`; 0 for others.
    pub number: u32,
    /// A `SubsurfMapping`.
    pub mapping: u32,
    /// Copies of the material in u and in v, for texture coordinates.
    pub copies: [f32; 2],
    /// GGX roughness of the smooth coat over the material, 0 to 1.
    pub roughness: f32,
    /// From mm of the mesh to mm of the world, column by column: a rotation, a uniform scale, a translation. The material keeps its own size.
    pub world_from_mesh: [f32; 16],
}

/// Everything that a frame shows. Set `struct_size`, `light_bytes` and `object_bytes` to the sizes of the structs; y is up, lengths are in mm,
/// matrices are column by column.
#[repr(C)]
#[derive(Clone, Copy, Debug)]
pub struct SubsurfFrame {
    /// Bytes of the caller's struct.
    pub struct_size: u32,
    /// `sizeof(SubsurfLight)`.
    pub light_bytes: u32,
    /// Number of lights, at most 8.
    pub light_count: u32,
    /// `sizeof(SubsurfObject)`.
    pub object_bytes: u32,
    /// Number of objects, at most `SubsurfRendererOptions::objects`.
    pub object_count: u32,
    /// Factor on radiance, before tone mapping (Khronos PBR Neutral).
    pub exposure: f32,
    /// Colour where no object is: R, G, B and coverage of display values, 0 to 1.
    pub background: [f32; 4],
    /// Point in mm at which lights from nearby have their irradiance.
    pub reference_mm: [f32; 3],
    /// From the world to the camera, which looks along -z, y up: rotation and translation.
    pub view_from_world: [f32; 16],
    /// Projection, in perspective or parallel: depth from 0 at the near plane to 1 at the far one. OpenGL's have -1 to 1: halve the third
    /// row, and add half of the fourth.
    pub clip_from_view: [f32; 16],
    /// Lights, or null.
    pub lights: *const SubsurfLight,
    /// Objects, or null.
    pub objects: *const SubsurfObject,
    /// Light from all around; null for none.
    pub environment: *const SubsurfEnvironment,
}

// SAFETY: `repr(C)`, and the size is first.
unsafe impl Versioned for SubsurfFrame {
    const NAME: &'static str = "SubsurfFrame";
    const FIRST_BYTES: usize = offset_of!(Self, environment) + size_of::<*const SubsurfEnvironment>();
}

/// Bytes of the first version of a light.
const LIGHT_BYTES: usize = offset_of!(SubsurfLight, irradiance) + size_of::<[f32; 3]>();
/// Bytes of the first version of an object.
const OBJECT_BYTES: usize = offset_of!(SubsurfObject, world_from_mesh) + size_of::<[f32; 16]>();

const NO_FRAME: SubsurfFrame = SubsurfFrame {
    struct_size: 0,
    light_bytes: 0,
    light_count: 0,
    object_bytes: 0,
    object_count: 0,
    exposure: 0.0,
    background: [0.0; 4],
    reference_mm: [0.0; 3],
    view_from_world: [0.0; 16],
    clip_from_view: [0.0; 16],
    lights: std::ptr::null(),
    objects: std::ptr::null(),
    environment: std::ptr::null(),
};

const NO_LIGHT: SubsurfLight = SubsurfLight {
    kind: 0,
    has_shadow: 0,
    place: [0.0; 3],
    target_mm: [0.0; 3],
    half_angle_rad: 0.0,
    irradiance: [0.0; 3],
};

const NO_OBJECT: SubsurfObject = SubsurfObject {
    mesh: std::ptr::null(),
    material: std::ptr::null(),
    number: 0,
    mapping: 0,
    copies: [0.0; 2],
    roughness: 0.0,
    world_from_mesh: [0.0; 16],
};

/// Object of a frame that was checked.
pub(crate) struct Checked<'a> {
    pub(crate) mesh: &'a OpenMesh,
    pub(crate) of: &'a OpenMaterial,
    pub(crate) material: Material,
    mapping: Mapping,
    world_from_mesh: Mat4,
    roughness: f32,
}

/// Frame that was checked.
pub(crate) struct Shown<'a> {
    pub(crate) view: View,
    pub(crate) exposure: f32,
    pub(crate) background: [f32; 4],
    pub(crate) reference_mm: Vec3,
    pub(crate) lights: Vec<Light>,
    pub(crate) objects: Vec<Checked<'a>>,
    pub(crate) environment: Option<&'a OpenEnvironment>,
}

impl<'a> Checked<'a> {
    /// As the renderer takes it.
    pub(crate) fn object(&self) -> Object<'_> {
        let Self { mesh, material, mapping, world_from_mesh, roughness, .. } = self;
        Object { world_from_mesh: *world_from_mesh, ..Object::new(&mesh.mesh, material, *mapping, *roughness) }
    }

    /// # Safety
    /// Handles of the object are null or open.
    unsafe fn new(gpu: &OpenGpu, object: &SubsurfObject) -> Result<Self> {
        // SAFETY: the caller's handles.
        let (mesh, of) = unsafe { (OpenMesh::of(object.mesh)?, OpenMaterial::of(object.material)?) };
        if !mesh.gpu.is(gpu) || !of.gpu.is(gpu) {
            return Err(Fault::invalid(
                "an object's mesh or material is on another SubsurfGpu than the renderer".to_owned(),
            ));
        }
        finite("world_from_mesh", &object.world_from_mesh)?;
        finite("copies", &object.copies)?;
        within("roughness", object.roughness, 0.0..=1.0)?;
        let mapping = one_of("mapping", object.mapping, &[Mapping::Uv(object.copies), Mapping::Box])?;
        Ok(Self {
            mesh,
            of,
            material: of.number(object.number)?,
            mapping,
            world_from_mesh: Mat4::from_cols_array(&object.world_from_mesh),
            roughness: object.roughness,
        })
    }
}

/// Light of a caller, checked.
fn light(light: &SubsurfLight) -> Result<Light> {
    finite("place", &light.place)?;
    finite("target_mm", &light.target_mm)?;
    for channel in light.irradiance {
        within("irradiance", channel, 0.0..=1e30)?;
    }
    let [place, target_mm] = [light.place, light.target_mm].map(Vec3::from);
    let kinds = [SubsurfLightKind::Directional, SubsurfLightKind::Point, SubsurfLightKind::Spot];
    let shape = match one_of("kind", light.kind, &kinds)? {
        SubsurfLightKind::Directional => LightShape::Directional { towards: place },
        SubsurfLightKind::Point => LightShape::Point { position_mm: place },
        SubsurfLightKind::Spot => {
            within("half_angle_rad", light.half_angle_rad, 1e-3..=75_f32.to_radians())?;
            LightShape::Spot { position_mm: place, target_mm, half_angle_rad: light.half_angle_rad }
        }
    };
    let shadow = if light.has_shadow == 0 { Shadow::None } else { Shadow::Drawn };
    Ok(Light { shape, irradiance: light.irradiance, shadow })
}

impl Shown<'_> {
    /// Frame of a caller, of `most_objects` at most.
    ///
    /// # Safety
    /// `frame` is null or leads to a frame as the header says, whose handles are open.
    pub(crate) unsafe fn new(gpu: &OpenGpu, frame: *const SubsurfFrame, most_objects: u32) -> Result<Self> {
        // SAFETY: the caller's struct, of numbers and pointers.
        let frame = unsafe { take("frame", frame, NO_FRAME) }?;
        finite("view_from_world", &frame.view_from_world)?;
        finite("clip_from_view", &frame.clip_from_view)?;
        finite("reference_mm", &frame.reference_mm)?;
        finite("background", &frame.background)?;
        within("exposure", frame.exposure, 0.0..=1e30)?;
        let [view_from_world, clip_from_view] =
            [frame.view_from_world, frame.clip_from_view].map(|columns| Mat4::from_cols_array(&columns));
        for (name, matrix) in [("view_from_world", view_from_world), ("clip_from_view", clip_from_view)] {
            let determinant = matrix.determinant();
            if !determinant.is_normal() {
                return Err(Fault::invalid(format!("{name} has the determinant {determinant}, expected is another")));
            }
        }
        let lights = Structs {
            name: "lights",
            of: "SubsurfLight",
            pointer: frame.lights,
            count: frame.light_count,
            bytes: frame.light_bytes,
            #[allow(clippy::cast_possible_truncation, reason = "8")]
            most: MAX_LIGHTS as u32,
        };
        let objects = Structs {
            name: "objects",
            of: "SubsurfObject",
            pointer: frame.objects,
            count: frame.object_count,
            bytes: frame.object_bytes,
            most: most_objects,
        };
        // SAFETY: the caller's arrays, of numbers and pointers.
        let (lights, objects) =
            unsafe { (lights.take(LIGHT_BYTES, NO_LIGHT)?, objects.take(OBJECT_BYTES, NO_OBJECT)?) };
        let environment = if frame.environment.is_null() {
            None
        } else {
            // SAFETY: the caller's handle.
            Some(unsafe { OpenEnvironment::of(frame.environment) }?)
        };
        Ok(Self {
            view: View { view_from_world, clip_from_view },
            exposure: frame.exposure,
            background: frame.background,
            reference_mm: frame.reference_mm.into(),
            lights: lights.iter().map(light).collect::<Result<_>>()?,
            // SAFETY: the caller's handles.
            objects: objects.iter().map(|object| unsafe { Checked::new(gpu, object) }).collect::<Result<_>>()?,
            environment,
        })
    }
}

/// Fills the two matrices of a frame with those of a camera that looks from one point at another, y up.
///
/// `frame`: its `struct_size` is set; nothing else of it is read or changed. `eye_mm`, `target_mm`: three numbers each. `fov_y_rad`: angle from the
/// lower to the upper edge, 0.001 to 3.1. `aspect`: width by height, 0.001 to 1,000. `near_mm`, `far_mm`: distances of the planes, more than 0.
/// Errors: `INVALID_ARGUMENT`.
/// Ownership: all are the caller's.
/// Threads: any.
///
/// # Safety
/// As above.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn subsurf_frame_look_at(
    frame: *mut SubsurfFrame,
    eye_mm: *const f32,
    target_mm: *const f32,
    fov_y_rad: f32,
    aspect: f32,
    near_mm: f32,
    far_mm: f32,
) -> SubsurfStatus {
    call(|| {
        // SAFETY: three numbers each, the caller's.
        let (eye, target) = unsafe { (read3("eye_mm", eye_mm)?, read3("target_mm", target_mm)?) };
        finite("eye_mm", &eye)?;
        finite("target_mm", &target)?;
        within("fov_y_rad", fov_y_rad, 1e-3..=3.1)?;
        within("aspect", aspect, 1e-3..=1e3)?;
        within("near_mm", near_mm, 1e-6..=1e9)?;
        within("far_mm", far_mm, near_mm * 1.001..=1e12)?;
        let [eye, target] = [eye, target].map(Vec3::from);
        let forward = (target - eye).try_normalize();
        let forward = forward.ok_or_else(|| Fault::invalid("eye_mm and target_mm are the same point".to_owned()))?;
        // Straight up and down, another direction is up.
        let up = if forward.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
        // SAFETY: the caller's struct, of numbers and pointers.
        let known = unsafe { take("frame", frame.cast_const(), NO_FRAME) }?;
        let value = SubsurfFrame {
            view_from_world: look_at_mat4(eye, eye + forward, up).to_cols_array(),
            clip_from_view: perspective(fov_y_rad, aspect, near_mm, far_mm).to_cols_array(),
            ..known
        };
        // SAFETY: the caller's struct.
        Ok(unsafe { fill("frame", frame, value) }?)
    })
}
