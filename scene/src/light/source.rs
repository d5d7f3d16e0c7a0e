//! Sources of light.

use glam::Vec3;

/// Most lights of a scene.
pub const MAX_LIGHTS: usize = 4;

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

impl Light {
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
