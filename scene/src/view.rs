//! How a picture is projected, as matrices: what an application has of its camera.

use glam::camera::rh::proj::directx::perspective;
use glam::camera::rh::view::look_at_mat4;
use glam::{Mat4, Vec2, Vec3, Vec4};

use crate::camera::Camera;
use crate::mesh::BoundingSphere;

/// View of a camera: two matrices. Lengths are in mm.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct View {
    /// From the world to the camera, which looks along −z, y up: rotation and translation.
    pub view_from_world: Mat4,
    /// Projection, in perspective or parallel, with its middle anywhere; depth from 0 to 1, or from 1 to 0 if it is reversed.
    pub clip_from_view: Mat4,
}

impl View {
    /// View of a camera for a picture `aspect` times as wide as high, with near and far planes that hold a sphere.
    #[must_use]
    pub fn new(camera: &Camera, bounds: &BoundingSphere, aspect: f32) -> Self {
        let forward = (camera.target_mm - camera.eye_mm).normalize_or(Vec3::NEG_Z);
        let middle_mm = (bounds.centre_mm - camera.eye_mm).dot(forward);
        // An eye within the sphere still sees what is further away than a hundredth of its size.
        let near = (middle_mm - bounds.radius_mm).max(0.01 * bounds.radius_mm);
        let far = (middle_mm + bounds.radius_mm).max(2.0 * near);
        let up = if forward.y.abs() > 0.999 { Vec3::Z } else { Vec3::Y };
        Self {
            view_from_world: look_at_mat4(camera.eye_mm, camera.eye_mm + forward, up),
            clip_from_view: perspective(camera.fov_y_rad, aspect, near, far),
        }
    }

    /// Projection of positions in the world.
    #[must_use]
    pub fn clip_from_world(&self) -> Mat4 {
        self.clip_from_view * self.view_from_world
    }

    /// Unit vector along which the camera looks.
    #[must_use]
    pub fn forward(&self) -> Vec3 {
        -self.view_from_world.row(2).truncate().normalize_or(Vec3::Z)
    }

    /// Whether lines of sight are parallel: things have the same size at all distances.
    #[must_use]
    pub fn is_parallel(&self) -> bool {
        self.clip_from_view.row(3) == Vec4::W
    }

    /// Position of the camera in mm.
    #[must_use]
    pub fn eye_mm(&self) -> Vec3 {
        self.view_from_world.inverse().w_axis.truncate()
    }

    /// Half the width and half the height of the picture are this many times something 1 mm large, 1 mm away; at any
    /// distance if the projection is parallel. Pictures may lie on their side, as screens do that are turned.
    #[must_use]
    pub fn focal(&self) -> Vec2 {
        let along = |row: Vec4| row.x.hypot(row.y);
        Vec2::new(along(self.clip_from_view.row(0)), along(self.clip_from_view.row(1)))
    }

    /// Whether any of a sphere may be in the picture.
    #[must_use]
    pub fn sees(&self, bounds: &BoundingSphere) -> bool {
        let clip = self.clip_from_world();
        let [x, y, z, w] = [0, 1, 2, 3].map(|row| clip.row(row));
        [w + x, w - x, w + y, w - y, z, w - z].into_iter().all(|plane| {
            // A far plane at infinity has no normal.
            let normal = plane.truncate();
            plane.dot(bounds.centre_mm.extend(1.0)) >= -bounds.radius_mm * normal.length()
        })
    }
}

#[cfg(test)]
mod tests {
    use glam::camera::rh::proj::directx::orthographic;

    use super::*;

    const BOUNDS: BoundingSphere = BoundingSphere { centre_mm: Vec3::new(1.0, 2.0, 3.0), radius_mm: 5.0 };

    fn camera() -> Camera {
        Camera { eye_mm: Vec3::new(30.0, 20.0, 50.0), target_mm: BOUNDS.centre_mm, fov_y_rad: 0.6, exposure: 1.0 }
    }

    #[test]
    fn matrices_say_where_the_camera_is() {
        let view = View::new(&camera(), &BOUNDS, 1.5);
        let forward = (BOUNDS.centre_mm - camera().eye_mm).normalize();
        assert!(view.eye_mm().distance(camera().eye_mm) < 1e-4, "{}", view.eye_mm());
        assert!(view.forward().distance(forward) < 1e-6, "{}", view.forward());
        let cotangent = 1.0 / 0.3_f32.tan();
        assert!(view.focal().distance(Vec2::new(cotangent / 1.5, cotangent)) < 1e-5, "{}", view.focal());
        assert!(!view.is_parallel(), "perspective");
        let quarter = Mat4::from_rotation_z(std::f32::consts::FRAC_PI_2);
        let turned = View { clip_from_view: quarter * view.clip_from_view, ..view };
        assert!(turned.focal().distance(Vec2::new(cotangent, cotangent / 1.5)) < 1e-5, "{}", turned.focal());
        let parallel = View { clip_from_view: orthographic(-2.0, 6.0, -1.0, 3.0, 1.0, 100.0), ..view };
        assert!(parallel.is_parallel(), "orthographic");
        assert!(parallel.focal().distance(Vec2::new(0.25, 0.5)) < 1e-6, "{}", parallel.focal());
    }

    #[test]
    fn spheres_beside_the_picture_are_not_seen() {
        let view = View::new(&camera(), &BOUNDS, 1.5);
        assert!(view.sees(&BOUNDS), "what it was made for");
        let right = view.view_from_world.row(0).truncate();
        let distance = camera().eye_mm.distance(BOUNDS.centre_mm);
        let edge = 1.5 * 0.3_f32.tan() * distance;
        for (along, seen) in [(0.0, true), (edge, true), (edge + 4.0, true), (edge + 6.5, false), (-edge - 6.5, false)]
        {
            let moved = BoundingSphere { centre_mm: BOUNDS.centre_mm + along * right, ..BOUNDS };
            assert_eq!(view.sees(&moved), seen, "{along} mm beside the middle");
        }
        let behind = BoundingSphere { centre_mm: camera().eye_mm - 20.0 * view.forward(), ..BOUNDS };
        assert!(!view.sees(&behind), "behind the eye");
        // Reversed depth without a far plane.
        let (near, cotangent) = (1.0, 2.0);
        let reversed = Mat4::from_cols(
            Vec4::new(cotangent, 0.0, 0.0, 0.0),
            Vec4::new(0.0, cotangent, 0.0, 0.0),
            Vec4::new(0.0, 0.0, 0.0, -1.0),
            Vec4::new(0.0, 0.0, near, 0.0),
        );
        let endless = View { clip_from_view: reversed, ..view };
        assert!(endless.sees(&BOUNDS), "in front");
        assert!(!endless.sees(&behind), "behind the eye");
    }
}
