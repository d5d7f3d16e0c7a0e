//! Blocks of what is drawn, from the scene's own types.

use bytemuck::{Pod, Zeroable};
use glam::camera::rh::proj::directx::{orthographic, perspective};
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use subsurf_scene::{BoundingSphere, Light, LightShape, Lighting, MAX_LIGHTS, Shadow, SurfacePoints, View};

/// Widest half angle of a light's view.
const WIDEST: f32 = 75.0 * std::f32::consts::PI / 180.0;
/// Eye of a parallel projection: so many radii of the scene away.
const FAR_AWAY: f32 = 1e4;
/// Views are this much wider than the scene: filters look beyond the last texel.
const MARGIN: f32 = 1.03;

/// Shadow of a light that shines through everything, as the block of a light has it.
pub const NO_SHADOW: u32 = 0;
/// Shadow by a tile of the translucent shadow maps.
pub const OWN_SHADOW: u32 = 1;
/// Shadow by a depth map of the host's, whose depth rises away from the light.
pub const HOST_SHADOW: u32 = 2;
/// Shadow by a depth map of the host's, whose depth falls away from the light.
pub const HOST_SHADOW_REVERSED: u32 = 3;

/// `PointGrid` of `surface_gather.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct PointGrid {
    /// Lowest corner of the grid in mm.
    pub origin_mm: [f32; 3],
    /// Edge of a cell in mm.
    pub cell_mm: f32,
    /// Numbers of cells in x, y and z.
    pub cells: [u32; 3],
    /// Number of points.
    pub points: u32,
}

/// `LightSource` of `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub struct LightSource {
    /// Projection of the light's own view, or of the host's map; column-major, depth 0 to 1.
    pub clip_from_world: [[f32; 4]; 4],
    /// Unit vector towards the light, or its position in mm.
    pub position_or_direction: [f32; 3],
    /// 0 for a direction, 1 for a position.
    pub is_local: u32,
    /// Irradiance on a plane that faces the light: of a direction anywhere, of a position 1 mm away; linear Rec. 709.
    pub irradiance: [f32; 3],
    /// Cosine of the angle from the axis beyond which there is no light.
    pub cos_outer: f32,
    /// Unit vector along the axis of the light, away from it.
    pub axis: [f32; 3],
    /// Cosine of the angle from the axis where light begins to fade.
    pub cos_inner: f32,
    /// Distance along the axis from the light to depth 0 in mm; 0 for a direction.
    pub middle_mm: f32,
    /// Edge of a texel of its translucent shadow map at depth 0, in mm.
    pub texel_mm: f32,
    /// [`NO_SHADOW`], [`OWN_SHADOW`], [`HOST_SHADOW`] or [`HOST_SHADOW_REVERSED`].
    pub shadow: u32,
    /// Number of the tile of the translucent shadow maps, or of the host's map.
    pub map: u32,
}

/// `Scene` of `scene.wgsl`.
#[repr(C)]
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
pub struct Scene {
    /// Projection of the camera; column-major, depth 0 to 1.
    pub clip_from_world: [[f32; 4]; 4],
    /// Position of the eye in mm; very far away where the projection is parallel.
    pub eye_mm: [f32; 3],
    /// Factor of radiance before tone mapping.
    pub exposure: f32,
    /// Unit vector along which the eye looks.
    pub forward: [f32; 3],
    /// Number of lights.
    pub lights: u32,
    /// Middle of the scene in mm, where depth is 0.
    pub centre_mm: [f32; 3],
    /// Texels to a side of a tile of the translucent shadow maps.
    pub light_texels: u32,
    /// Tiles in a row of them, at least 1.
    pub light_columns: u32,
    #[doc(hidden)]
    pub pad: [u32; 3],
    /// Irradiance of the environment on a normal (x, y, z): coefficients of 1, y, z, x, xy, yz, 3z² − 1, xz, x² − y².
    pub sky: [[f32; 4]; 9],
    /// Lights, of which the first `lights` count.
    pub light: [LightSource; MAX_LIGHTS],
}

impl PointGrid {
    /// The block for the points of a surface.
    #[must_use]
    pub fn new(points: &SurfacePoints) -> Self {
        let grid = points.grid;
        Self { origin_mm: grid.origin_mm.into(), cell_mm: grid.cell_mm, cells: grid.cells.into(), points: grid.points }
    }
}

impl Scene {
    /// Block of what lies within a sphere, when lights have views of `light_texels` to a side, all in one row. Lights with shadows of
    /// our own have the tiles in their order; of the host's maps only the number is known here.
    #[must_use]
    pub fn new(
        view: &View,
        exposure: f32,
        lighting: &Lighting<'_>,
        bounds: &BoundingSphere,
        light_texels: u32,
    ) -> Self {
        let forward = view.forward();
        let eye_mm =
            if view.is_parallel() { bounds.centre_mm - FAR_AWAY * bounds.radius_mm * forward } else { view.eye_mm() };
        let mut block = Self {
            clip_from_world: view.clip_from_world().to_cols_array_2d(),
            eye_mm: eye_mm.into(),
            exposure,
            forward: forward.into(),
            lights: u32::try_from(lighting.lights.len().min(MAX_LIGHTS)).unwrap_or(0),
            centre_mm: bounds.centre_mm.into(),
            light_texels,
            light_columns: 1,
            pad: [0; 3],
            sky: [[0.0; 4]; 9],
            light: [LightSource::default(); MAX_LIGHTS],
        };
        for (to, [r, g, b]) in block.sky.iter_mut().zip(lighting.environment.irradiance_coefficients()) {
            *to = [*r, *g, *b, 0.0];
        }
        let mut tiles = 0;
        for (to, light) in block.light.iter_mut().zip(lighting.lights) {
            *to = LightSource::of(light, lighting.reference_mm, bounds, light_texels);
            (to.shadow, to.map) = match light.shadow {
                Shadow::None => (NO_SHADOW, 0),
                Shadow::Drawn => (OWN_SHADOW, tiles),
                Shadow::Host(number) => (HOST_SHADOW, u32::try_from(number).unwrap_or(u32::MAX)),
            };
            tiles += u32::from(light.shadow == Shadow::Drawn);
        }
        block.light_columns = tiles.max(1);
        block
    }
}

impl Scene {
    /// Numbers of the lights whose shadows are drawn, in the order of their tiles.
    pub fn drawn_shadows(&self) -> impl Iterator<Item = u32> + '_ {
        let lights = self.light.iter().zip(0..self.lights);
        lights.filter(|(light, _)| light.shadow == OWN_SHADOW).map(|(_, number)| number)
    }
}

impl LightSource {
    /// Block for a scene within a sphere, when the light's view has `texels` to a side.
    fn of(light: &Light, reference_mm: Vec3, bounds: &BoundingSphere, texels: u32) -> Self {
        let BoundingSphere { centre_mm, radius_mm } = *bounds;
        #[allow(clippy::cast_precision_loss, reason = "a thousand")]
        let texels = texels as f32;
        match light.shape {
            LightShape::Directional { towards } => {
                let towards = towards.normalize_or(Vec3::Y);
                let half = MARGIN * radius_mm;
                let view = looking(centre_mm + 2.0 * radius_mm * towards, -towards);
                let clip = orthographic(-half, half, -half, half, 0.9 * radius_mm, 3.1 * radius_mm);
                Self {
                    clip_from_world: (clip * view).to_cols_array_2d(),
                    position_or_direction: towards.into(),
                    irradiance: light.irradiance,
                    axis: (-towards).into(),
                    texel_mm: 2.0 * half / texels,
                    ..Default::default()
                }
            }
            LightShape::Point { position_mm } => {
                let to_centre = centre_mm - position_mm;
                let share = (MARGIN * radius_mm / to_centre.length().max(1e-6)).min(1.0);
                // All around: no cosine is below these.
                Self::local(light, reference_mm, [position_mm, to_centre], share.asin(), [-3.0, -2.0], bounds, texels)
            }
            LightShape::Spot { position_mm, target_mm, half_angle_rad } => {
                let half_angle = half_angle_rad.clamp(0.01, WIDEST);
                let cone = [half_angle.cos(), (0.9 * half_angle).cos()];
                let ray = [position_mm, target_mm - position_mm];
                Self::local(light, reference_mm, ray, half_angle, cone, bounds, texels)
            }
        }
    }

    /// Block of a light that shines from a position along a vector.
    fn local(
        light: &Light,
        reference_mm: Vec3,
        [position_mm, along]: [Vec3; 2],
        half_angle: f32,
        [cos_outer, cos_inner]: [f32; 2],
        bounds: &BoundingSphere,
        texels: f32,
    ) -> Self {
        let BoundingSphere { centre_mm, radius_mm } = *bounds;
        let axis = along.normalize_or(Vec3::NEG_Y);
        let half_angle = half_angle.clamp(0.01, WIDEST);
        let distance = position_mm.distance(centre_mm);
        let middle_mm = (centre_mm - position_mm).dot(axis).max(1e-3 * radius_mm);
        let near = (distance - MARGIN * radius_mm).max(0.02 * radius_mm);
        let squared_mm2 = position_mm.distance_squared(reference_mm);
        let clip = perspective(2.0 * half_angle, 1.0, near * half_angle.cos(), distance + 2.0 * radius_mm);
        let view = looking(position_mm, axis);
        Self {
            clip_from_world: (clip * view).to_cols_array_2d(),
            position_or_direction: position_mm.into(),
            is_local: 1,
            irradiance: light.irradiance.map(|value| value * squared_mm2),
            cos_outer,
            axis: axis.into(),
            cos_inner,
            middle_mm,
            texel_mm: 2.0 * half_angle.tan() * middle_mm / texels,
            ..Default::default()
        }
    }
}

/// From `eye` along a unit vector.
fn looking(eye: Vec3, along: Vec3) -> Mat4 {
    let up = if along.y.abs() > 0.95 { Vec3::Z } else { Vec3::Y };
    look_at_mat4(eye, eye + along, up)
}
