//! What a frame shows, as Kotlin packs it into two arrays: see `Scene.kt`.

use jni_sys::jlong;
use subsurf_c_draw::{SubsurfEnvironment, SubsurfFrame, SubsurfLight, SubsurfObject};

use crate::convert::{pointer, struct_size};

/// Numbers before the lights: two matrices, exposure, reference, background.
const FRAME: usize = 40;
/// Numbers of a light.
const LIGHT: usize = 12;
/// Numbers of an object.
const OBJECT: usize = 21;

/// Frame and what it points to.
pub(crate) struct Frame {
    numbers: [f32; FRAME],
    environment: *const SubsurfEnvironment,
    lights: Vec<SubsurfLight>,
    objects: Vec<SubsurfObject>,
}

/// Number of an enumeration, which travelled as a float.
fn kind(value: f32) -> u32 {
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "small whole numbers")]
    let kind = value as u32;
    kind
}

impl Frame {
    /// Frame of packed numbers, and of handles: the environment, then mesh and material of each object. Lights are what the
    /// objects leave of the numbers.
    pub(crate) fn new(numbers: &[f32], handles: &[jlong]) -> Self {
        let (first, rest) = numbers.split_first_chunk::<FRAME>().unwrap_or((&[0.0; FRAME], &[]));
        let (environment, pairs) = handles.split_first().map_or((0, handles), |(first, rest)| (*first, rest));
        let pairs = pairs.as_chunks::<2>().0;
        let of_objects = pairs.len().saturating_mul(OBJECT).min(rest.len());
        let (lights, objects) = rest.split_at(rest.len().saturating_sub(of_objects));
        Self {
            numbers: *first,
            environment: pointer::<SubsurfEnvironment>(environment),
            lights: lights.as_chunks().0.iter().map(light).collect(),
            objects: objects.as_chunks().0.iter().zip(pairs).map(|(numbers, pair)| object(numbers, *pair)).collect(),
        }
    }

    /// Calls with the struct of C.
    pub(crate) fn with<T>(&self, work: impl FnOnce(*const SubsurfFrame) -> T) -> T {
        let (view_from_world, rest) = self.numbers.split_first_chunk().unwrap_or((&[0.0; 16], &[]));
        let (clip_from_view, rest) = rest.split_first_chunk().unwrap_or((&[0.0; 16], &[]));
        let [exposure, x, y, z, red, green, blue, alpha] = *rest.first_chunk().unwrap_or(&[0.0; 8]);
        let frame = SubsurfFrame {
            struct_size: struct_size::<SubsurfFrame>(),
            light_bytes: struct_size::<SubsurfLight>(),
            light_count: u32::try_from(self.lights.len()).unwrap_or(u32::MAX),
            object_bytes: struct_size::<SubsurfObject>(),
            object_count: u32::try_from(self.objects.len()).unwrap_or(u32::MAX),
            exposure,
            background: [red, green, blue, alpha],
            reference_mm: [x, y, z],
            view_from_world: *view_from_world,
            clip_from_view: *clip_from_view,
            lights: self.lights.as_ptr(),
            objects: self.objects.as_ptr(),
            environment: self.environment,
        };
        work(&raw const frame)
    }
}

fn light(
    &[of, shadow, x, y, z, target_x, target_y, target_z, half_angle_rad, red, green, blue]: &[f32; LIGHT],
) -> SubsurfLight {
    SubsurfLight {
        kind: kind(of),
        has_shadow: kind(shadow),
        place: [x, y, z],
        target_mm: [target_x, target_y, target_z],
        half_angle_rad,
        irradiance: [red, green, blue],
    }
}

fn object(numbers: &[f32; OBJECT], [mesh, material]: [jlong; 2]) -> SubsurfObject {
    let (world_from_mesh, rest) = numbers.split_first_chunk().unwrap_or((&[0.0; 16], &[]));
    let [number, mapping, u, v, roughness] = *rest.first_chunk().unwrap_or(&[0.0; 5]);
    SubsurfObject {
        mesh: pointer(mesh),
        material: pointer(material),
        number: kind(number),
        mapping: kind(mapping),
        copies: [u, v],
        roughness,
        world_from_mesh: *world_from_mesh,
    }
}
