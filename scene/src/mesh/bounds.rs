//! Bounds of meshes.

use glam::{Mat4, Vec3};

/// Sphere that holds a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoundingSphere {
    /// Middle of the mesh's bounding box, in mm.
    pub centre_mm: Vec3,
    /// Distance of the furthest vertex from there, in mm; at least 0.001.
    pub radius_mm: f32,
}

impl BoundingSphere {
    /// Sphere that holds this one after a rotation, a scale and a translation.
    #[must_use]
    pub fn transformed(&self, world_from_mesh: &Mat4) -> Self {
        let scale = world_from_mesh.x_axis.truncate().length();
        Self { centre_mm: world_from_mesh.transform_point3(self.centre_mm), radius_mm: scale * self.radius_mm }
    }

    /// Smallest sphere that holds two.
    #[must_use]
    pub fn union(&self, other: &Self) -> Self {
        let distance = self.centre_mm.distance(other.centre_mm);
        if distance + other.radius_mm <= self.radius_mm {
            return *self;
        }
        if distance + self.radius_mm <= other.radius_mm {
            return *other;
        }
        let radius_mm = 0.5 * (distance + self.radius_mm + other.radius_mm);
        let part = (radius_mm - self.radius_mm) / distance;
        Self { centre_mm: self.centre_mm.lerp(other.centre_mm, part), radius_mm }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn unions_hold_both() {
        let sphere = |x, radius_mm| BoundingSphere { centre_mm: Vec3::new(x, 0.0, 0.0), radius_mm };
        assert_eq!(sphere(0.0, 1.0).union(&sphere(6.0, 3.0)), sphere(4.0, 5.0));
        assert_eq!(sphere(0.0, 9.0).union(&sphere(6.0, 3.0)), sphere(0.0, 9.0));
        assert_eq!(sphere(6.0, 1.0).union(&sphere(0.0, 9.0)), sphere(0.0, 9.0));
        let moved = Mat4::from_translation(Vec3::X) * Mat4::from_scale(Vec3::splat(2.0));
        assert_eq!(sphere(3.0, 2.0).transformed(&moved), sphere(7.0, 4.0));
    }
}
