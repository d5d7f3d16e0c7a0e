//! What is drawn: meshes, lights, the environment and the eye; and the points between which light scatters.

mod environment;
mod light;
mod mesh;
mod shapes;
mod sky;
mod surface;
mod tangents;

use glam::Vec3;
use glam::camera::rh::proj::directx::perspective;
use glam::camera::rh::view::look_at_mat4;
use subsurf_decoder::bssrdf::{Addressing, BssrdfHeader, Coding};
use subsurf_shaders::cpu::diffuse_transmittance;
use subsurf_shaders::uniform::{self, MAX_LIGHTS};

use crate::resource::ROW;

pub use environment::{Environment, REFLECTION_LEVELS, REFLECTION_SIZE};
pub use light::{Light, LightShape};
pub use mesh::Mesh;
pub use shapes::{bowl, drapery, knot, relief, sphere, torus};
pub use sky::SkyShare;
pub use surface::{Mapping, Surface};

/// Lights, environment, coat and eye, the same for every path.
#[derive(Clone, Debug)]
pub struct Scene {
    /// The first four count.
    pub lights: Vec<Light>,
    /// Light from all around.
    pub environment: Environment,
    /// GGX roughness of the smooth dielectric coat over the scattering, 0 to 1.
    pub roughness: f32,
    /// Where the picture is taken from.
    pub view: View,
}

/// Where a picture is taken from.
#[derive(Clone, Copy, Debug)]
pub struct View {
    /// Eye, in mm.
    pub eye_mm: Vec3,
    /// What the eye looks at, in mm.
    pub target_mm: Vec3,
    /// Vertical angle of view in radians.
    pub angle: f32,
    /// Multiplies radiance before tone mapping.
    pub exposure: f32,
}

/// What is known of a mesh and its material besides their tables.
#[derive(Clone, Copy, Debug)]
pub struct Outline {
    /// Middle of the mesh, in mm.
    pub centre_mm: Vec3,
    /// Radius of a sphere around it that holds the mesh, in mm.
    pub radius_mm: f32,
    /// Pitch, refractive index and so on of the material.
    pub header: BssrdfHeader,
    /// Where the material lies on the mesh.
    pub mapping: Mapping,
}

impl Outline {
    /// Of a mesh made of a material.
    #[must_use]
    pub fn new(mesh: &Mesh, mapping: Mapping, header: &BssrdfHeader) -> Self {
        let [low, high] = mesh.bounds();
        let centre_mm = 0.5 * (low + high);
        let radius_mm = mesh.positions.iter().map(|position| position.distance(centre_mm)).fold(1e-3, f32::max);
        Self { centre_mm, radius_mm, header: *header, mapping }
    }

    /// Of a mesh made of a BTF, which has no size of its own and lets no light in: copies of it to the unit square of
    /// texture coordinates, in u and in v.
    #[must_use]
    pub fn of_btf(mesh: &Mesh, copies: [f32; 2]) -> Self {
        let nothing = BssrdfHeader {
            model: 0,
            coding: Coding::Exact,
            addressing: Addressing::Repeat,
            width: 1,
            height: 1,
            window_radius: 1,
            samples: 2,
            base_materials: 1,
            pitch_mm: 1.0,
            r_max_mm: 1.0,
            eta: 1.0,
        };
        Self::new(mesh, Mapping::Uv(copies), &nothing)
    }
}

impl Scene {
    /// The uniform block for a picture of `size` of one mesh, when lights have views of `light_texels` to a side.
    #[must_use]
    pub fn block(&self, outline: &Outline, size: [u32; 2], light_texels: u32) -> uniform::Scene {
        #[allow(clippy::cast_precision_loss, reason = "pictures and patches are a few thousand pixels wide")]
        let [aspect, width, height] =
            [size[0] as f32 / size[1] as f32, outline.header.width as f32, outline.header.height as f32];
        let view = &self.view;
        let forward = (view.target_mm - view.eye_mm).normalize_or(Vec3::NEG_Z);
        let middle_mm = (outline.centre_mm - view.eye_mm).dot(forward);
        // Near and far hold the mesh; an eye within it still sees what is further away than a hundredth of its size.
        let near = (middle_mm - outline.radius_mm).max(0.01 * outline.radius_mm);
        let far = (middle_mm + outline.radius_mm).max(2.0 * near);
        let clip_from_view = perspective(view.angle, aspect, near, far);
        let up = if forward.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
        let view_from_world = look_at_mat4(view.eye_mm, view.eye_mm + forward, up);
        let pitch_mm = outline.header.pitch_mm;
        let mut block = uniform::Scene {
            clip_from_world: (clip_from_view * view_from_world).to_cols_array_2d(),
            eye_mm: view.eye_mm.into(),
            exposure: view.exposure,
            forward: forward.into(),
            middle_mm,
            centre_mm: outline.centre_mm.into(),
            eta: outline.header.eta,
            sky_transmittance: diffuse_transmittance(outline.header.eta),
            roughness: self.roughness.clamp(0.0, 1.0),
            lights: u32::try_from(self.lights.len().min(MAX_LIGHTS)).unwrap_or(0),
            row: ROW,
            patches_per_mm: [1.0 / (pitch_mm * width), 1.0 / (pitch_mm * height)],
            pitch_mm,
            is_boxed: u32::from(outline.mapping == Mapping::Box),
            sky: [[0.0; 4]; 9],
            light: [uniform::LightSource::default(); MAX_LIGHTS],
        };
        for (to, [r, g, b]) in block.sky.iter_mut().zip(self.environment.irradiance_coefficients()) {
            *to = [*r, *g, *b, 0.0];
        }
        for (to, light) in block.light.iter_mut().zip(&self.lights) {
            *to = light.block(outline.centre_mm, outline.radius_mm, light_texels);
        }
        block
    }
}
