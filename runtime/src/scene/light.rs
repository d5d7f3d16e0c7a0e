//! Lights, and the views from which they see the scene.

use glam::camera::rh::proj::directx::{orthographic, perspective};
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec3};
use subsurf_shaders::uniform::LightSource;

/// A source of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Where it is and where it shines.
    pub shape: LightShape,
    /// Irradiance on a plane that faces it, linear Rec. 709: anywhere from afar, and at the middle of the scene from
    /// nearby, where it falls with the square of the distance.
    pub irradiance: [f32; 3],
}

/// Where a light is and where it shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// From afar, from one direction.
    Directional {
        /// Towards the light; need not be of unit length.
        towards: Vec3,
    },
    /// From a point, all around. What it lights should be within 75° of the direction to the middle of the scene: its
    /// shadows are known no further.
    Point {
        /// In mm.
        position_mm: Vec3,
    },
    /// From a point, within a cone.
    Spot {
        /// In mm.
        position_mm: Vec3,
        /// Where the axis of the cone goes through, in mm.
        target_mm: Vec3,
        /// Half the angle of the cone in radians, at most 75°; light fades over its outer tenth.
        half_angle: f32,
    },
}

/// Widest half angle of a light's view.
const WIDEST: f32 = 75.0 * std::f32::consts::PI / 180.0;
/// Views are this much wider than the scene: filters look beyond the last texel.
const MARGIN: f32 = 1.03;

impl Light {
    /// The uniform block for a scene within a sphere, when the light's view has `texels` to a side.
    pub(crate) fn block(&self, centre_mm: Vec3, radius_mm: f32, texels: u32) -> LightSource {
        #[allow(clippy::cast_precision_loss, reason = "a thousand")]
        let texels = texels as f32;
        match self.shape {
            LightShape::Directional { towards } => {
                let towards = towards.normalize_or(Vec3::Y);
                let half = MARGIN * radius_mm;
                let view = looking(centre_mm + 2.0 * radius_mm * towards, -towards);
                let clip = orthographic(-half, half, -half, half, 0.9 * radius_mm, 3.1 * radius_mm);
                LightSource {
                    clip_from_world: (clip * view).to_cols_array_2d(),
                    place: towards.into(),
                    irradiance: self.irradiance,
                    axis: (-towards).into(),
                    texel_mm: 2.0 * half / texels,
                    ..Default::default()
                }
            }
            LightShape::Point { position_mm } => {
                let to_centre = centre_mm - position_mm;
                let share = (MARGIN * radius_mm / to_centre.length().max(1e-6)).min(1.0);
                // All around: no cosine is below these.
                self.local(position_mm, to_centre, share.asin(), [-3.0, -2.0], (centre_mm, radius_mm, texels))
            }
            LightShape::Spot { position_mm, target_mm, half_angle } => {
                let half_angle = half_angle.clamp(0.01, WIDEST);
                let cone = [half_angle.cos(), (0.9 * half_angle).cos()];
                self.local(position_mm, target_mm - position_mm, half_angle, cone, (centre_mm, radius_mm, texels))
            }
        }
    }

    fn local(
        &self,
        position_mm: Vec3,
        along: Vec3,
        half_angle: f32,
        [cos_outer, cos_inner]: [f32; 2],
        (centre_mm, radius_mm, texels): (Vec3, f32, f32),
    ) -> LightSource {
        let axis = along.normalize_or(Vec3::NEG_Y);
        let half_angle = half_angle.clamp(0.01, WIDEST);
        let distance = position_mm.distance(centre_mm);
        let middle_mm = (centre_mm - position_mm).dot(axis).max(1e-3 * radius_mm);
        let near = (distance - MARGIN * radius_mm).max(0.02 * radius_mm);
        let clip = perspective(2.0 * half_angle, 1.0, near * half_angle.cos(), distance + 2.0 * radius_mm);
        let view = looking(position_mm, axis);
        LightSource {
            clip_from_world: (clip * view).to_cols_array_2d(),
            place: position_mm.into(),
            is_local: 1,
            irradiance: self.irradiance.map(|value| value * distance * distance),
            cos_outer,
            axis: axis.into(),
            cos_inner,
            middle_mm,
            texel_mm: 2.0 * half_angle.tan() * middle_mm / texels,
            ..Default::default()
        }
    }

    /// Unit vector from a point towards the light, and the distance to it in mm.
    #[must_use]
    pub fn direction_from(&self, point_mm: Vec3) -> (Vec3, f32) {
        match self.shape {
            LightShape::Directional { towards } => (towards.normalize_or(Vec3::Y), f32::INFINITY),
            LightShape::Point { position_mm } | LightShape::Spot { position_mm, .. } => {
                ((position_mm - point_mm).normalize_or(Vec3::Y), position_mm.distance(point_mm))
            }
        }
    }
}

/// From `eye` along a unit vector.
fn looking(eye: Vec3, along: Vec3) -> Mat4 {
    let up = if along.y.abs() > 0.95 { Vec3::Z } else { Vec3::Y };
    look_at_mat4(eye, eye + along, up)
}
