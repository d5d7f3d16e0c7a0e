//! Sources of light.

use glam::Vec3;

/// Most lights of a scene, with shadows or without.
pub const MAX_LIGHTS: usize = 8;

/// Source of light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Position or direction.
    pub shape: LightShape,
    /// Irradiance on a plane that faces the light, linear Rec. 709, in the scene's own unit: anywhere from afar; at the middle
    /// of the mesh from nearby, where it falls with the square of the distance.
    pub irradiance: [f32; 3],
    /// What is behind objects.
    pub shadow: Shadow,
}

/// How it is known where a light does not reach.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Shadow {
    /// Not at all: the light shines through everything, and takes no memory and no pass.
    None,
    /// From a shadow map that is drawn with the frame; where visibilities are of vertices, from rays.
    #[default]
    Drawn,
    /// From the host's own shadow map of this number, from 0, among those of the frame; where visibilities are of vertices,
    /// from rays.
    Host(usize),
}

/// Position or direction of a light, and the part of space that it shines into.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum LightShape {
    /// Directional light, from afar.
    Directional {
        /// Direction towards the light, of any length.
        towards: Vec3,
    },
    /// Point light, which shines all around. What it lights should be within 75° of the direction to the middle of the mesh:
    /// its shadows are known no further.
    Point {
        /// Position in mm.
        position_mm: Vec3,
    },
    /// Spot light, which shines from a point into a cone.
    Spot {
        /// Position in mm.
        position_mm: Vec3,
        /// Point on the axis of the cone, in mm.
        target_mm: Vec3,
        /// Angle from the axis to the side of the cone in radians, at most 75°; light fades over its outer tenth.
        half_angle_rad: f32,
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
