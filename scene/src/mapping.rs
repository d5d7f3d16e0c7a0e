//! Mapping of materials to surfaces; the twin of `mapping.wgsl`.

use glam::{Vec2, Vec3};

/// Rule by which pixels of a patch lie on a surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Mapping {
    /// Texture coordinates; the unit square of them shows so many copies of the patch in u and in v.
    Uv([f32; 2]),
    /// Box mapping: the patch in its own size, from the sides of a box that [`Mesh::sides`](crate::Mesh::sides) names.
    Box,
}

/// Shares of the sides of a box at a vertex: of the sides that face x, y and z as steps of 1/127, negative where it is the side
/// that faces −x, −y or −z; 0 in the fourth place. Linear between vertices; of three shares the least is taken off all.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BoxSides(pub [i8; 4]);

/// Places of the material at a point: one side of the box, or two that are blended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BoxPlaces {
    /// Coordinates in mm on each of the two sides.
    pub at_mm: [Vec2; 2],
    /// Share of the first, 0.5 to 1; f = exp(P̂ / 2) is blended by it, and so is all that is linear in f.
    pub share: f32,
}

/// Steps to a share of 1.
const STEPS: f32 = 127.0;

impl BoxSides {
    /// Shares, each −1 to 1.
    #[must_use]
    pub fn new(shares: Vec3) -> Self {
        #[allow(clippy::cast_possible_truncation, reason = "saturates")]
        let [x, y, z] = (shares * STEPS).round().to_array().map(|step| step as i8);
        Self([x, y, z, 0])
    }

    /// Shares by a normal alone: of the side that it faces most, of two where it faces both alike.
    #[must_use]
    pub fn facing(normal: Vec3) -> Self {
        let n8 = normal.powf(2.0).powf(4.0);
        Self::new(n8 / n8.element_sum() * normal.signum())
    }

    /// Shares halfway between two.
    #[must_use]
    pub fn middle(self, other: Self) -> Self {
        Self::new((self.shares() + other.shares()) * 0.5)
    }

    /// The shares, each −1 to 1.
    #[must_use]
    pub fn shares(self) -> Vec3 {
        let [x, y, z, _] = self.0.map(f32::from);
        Vec3::new(x, y, z) / STEPS
    }

    /// Places of the material at a position in mm.
    #[must_use]
    pub fn places(self, position_mm: Vec3) -> BoxPlaces {
        let shares = self.shares();
        let of = shares.abs().to_array();
        let first = if of[0] >= of[1] && of[0] >= of[2] {
            0
        } else if of[1] >= of[2] {
            1
        } else {
            2
        };
        let [next, last] = [(first + 1) % 3, (first + 2) % 3];
        let [second, least] = if of[next] >= of[last] { [next, last] } else { [last, next] };
        let [a, b] = [of[first] - of[least], of[second] - of[least]];
        BoxPlaces {
            at_mm: [first, second].map(|side| on_side(side, position_mm, shares)),
            share: if b > 0.0 { a / (a + b) } else { 1.0 },
        }
    }
}

/// Coordinates in mm on the side that faces x, y or z, true to size and upright where they can be.
fn on_side(side: usize, p: Vec3, shares: Vec3) -> Vec2 {
    let sign = |share: f32| if share >= 0.0 { 1.0 } else { -1.0 };
    match side {
        0 => Vec2::new(-p.z * sign(shares.x), -p.y),
        1 => Vec2::new(p.x, p.z * sign(shares.y)),
        _ => Vec2::new(p.x * sign(shares.z), -p.y),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_sides_are_blended_and_the_third_fades() {
        let p = Vec3::new(1.0, 2.0, 3.0);
        let one = BoxSides::new(Vec3::new(0.0, 0.0, -1.0)).places(p);
        assert_eq!((one.at_mm[0], one.share), (Vec2::new(-1.0, -2.0), 1.0), "the back");
        let two = BoxSides::new(Vec3::new(0.75, 0.0, 0.25)).places(p);
        assert_eq!(two.at_mm, [Vec2::new(-3.0, -2.0), Vec2::new(1.0, -2.0)], "right and front");
        assert!((two.share - 0.75).abs() < 0.01, "{two:?}");
        // Where the second and the third change places, neither is seen.
        let three = BoxSides::new(Vec3::new(0.5, 0.25, 0.25)).places(p);
        assert_eq!(three.share, 1.0, "{three:?}");
        assert_eq!(BoxSides::default().places(p).share, 1.0, "no share of any side");
        let middle = BoxSides::facing(Vec3::X).middle(BoxSides::facing(Vec3::Y));
        assert_eq!(middle.places(p).share, 0.5, "{middle:?}");
    }
}
