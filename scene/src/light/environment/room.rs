//! Radiance of built-in surroundings: walls, a soft light overhead, and a strip of light on the left.

use glam::{Vec2, Vec3};

/// Surroundings of a photographer.
pub(super) struct Room {
    /// Radiance of the walls at the height of the eye, and how much of it they gain from there to straight up.
    walls: Vec3,
    gain: f32,
    /// Box on the plane y = 1, in x and z.
    overhead: Panel,
    /// Strip on the plane x = −1, in z and y.
    strip: Panel,
}

/// Rectangle of light with soft edges.
struct Panel {
    centre: Vec2,
    half: Vec2,
    radiance: Vec3,
}

/// Studio: a large box, a warm strip.
pub(super) const STUDIO: Room = Room {
    walls: Vec3::new(0.13, 0.14, 0.16),
    gain: 0.4,
    overhead: Panel { centre: Vec2::new(0.0, 0.3), half: Vec2::new(0.8, 0.6), radiance: Vec3::new(0.42, 0.44, 0.46) },
    strip: Panel { centre: Vec2::new(0.9, 0.2), half: Vec2::new(0.25, 0.7), radiance: Vec3::new(0.7, 0.62, 0.5) },
};

/// Stage by night: a faint, cool box behind what is seen from z and x, a tall strip.
pub(super) const STAGE: Room = Room {
    walls: Vec3::new(0.030, 0.040, 0.060),
    gain: 0.5,
    overhead: Panel { centre: Vec2::new(-0.4, -1.0), half: Vec2::new(0.9, 0.7), radiance: Vec3::new(0.16, 0.20, 0.28) },
    strip: Panel { centre: Vec2::new(1.1, 0.5), half: Vec2::new(0.2, 0.8), radiance: Vec3::new(0.30, 0.36, 0.48) },
};

impl Room {
    /// Radiance from a unit direction, linear Rec. 709.
    pub(super) fn radiance(&self, direction: Vec3) -> Vec3 {
        let walls = self.walls * (1.0 + self.gain * direction.y);
        let overhead = if direction.y > 0.1 {
            let on_plane = direction / direction.y;
            self.overhead.cover(Vec2::new(on_plane.x, on_plane.z))
        } else {
            0.0
        };
        let strip = if direction.x < -0.1 {
            let on_plane = direction / -direction.x;
            self.strip.cover(Vec2::new(on_plane.z, on_plane.y))
        } else {
            0.0
        };
        walls + overhead * self.overhead.radiance + strip * self.strip.radiance
    }
}

impl Panel {
    /// 1 within the rectangle, falling to 0 over a soft edge of 0.1 around it.
    fn cover(&self, at: Vec2) -> f32 {
        let within = |distance: f32, half: f32| ((half + 0.05 - distance) / 0.1).clamp(0.0, 1.0);
        let distance = (at - self.centre).abs();
        within(distance.x, self.half.x) * within(distance.y, self.half.y)
    }
}
