//! Sets: what stands around a mesh in a picture, and from where both are lit and seen.

use std::borrow::Cow;

use glam::{Vec2, Vec3};
use subsurf_runtime::RuntimeOptions;
use subsurf_scene::{BoundingSphere, Environment, Mesh, plate};

/// Position of the eye around a mesh, in degrees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles {
    /// Around the up axis, from z towards x.
    pub around: f32,
    /// Above the horizon, between −90 and 90.
    pub up: f32,
}

/// Light, surroundings, ground and place of the eye around any mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Set {
    /// Nothing but the mesh, lit over the right shoulder in a photographer's studio: all of its near side is seen.
    #[default]
    Studio,
    /// The mesh on a plate of the same material, lit from behind on a dark stage: light comes through what is thin, and bleeds
    /// into shadows.
    Hero,
}

/// Radius of the plate, and how deep the mesh stands in it, in radii of the mesh.
const PLATE: f32 = 2.1;
const SUNK: f32 = 0.012;
/// Thickness of the plate in radii of the mesh.
const PLATE_THICKNESS: f32 = 0.16;
/// Rings of quads of the plate.
const PLATE_RINGS: u16 = 28;

impl Set {
    /// Unit vector towards the light.
    #[must_use]
    pub fn towards_light(self) -> Vec3 {
        match self {
            Self::Studio => Vec3::new(0.9, 1.1, 0.35),
            Self::Hero => Vec3::new(-0.92, 0.62, -0.52),
        }
        .normalize()
    }

    /// Irradiance of the light on a plane that faces it, linear Rec. 709.
    #[must_use]
    pub fn irradiance(self) -> [f32; 3] {
        match self {
            Self::Studio => [3.0, 2.9, 2.7],
            Self::Hero => [4.2, 3.75, 3.0],
        }
    }

    /// Texels to a side of what the light sees: more where it sees ground, too.
    #[must_use]
    pub fn light_texels(self) -> u32 {
        match self {
            Self::Studio => RuntimeOptions::default().light_texels,
            Self::Hero => 1024,
        }
    }

    /// Light from all around.
    #[must_use]
    pub fn environment(self) -> Environment {
        match self {
            Self::Studio => Environment::studio(),
            Self::Hero => Environment::stage(),
        }
    }

    /// Place of the eye.
    #[must_use]
    pub fn angles(self) -> Angles {
        match self {
            Self::Studio => Angles { around: 30.0, up: 15.0 },
            Self::Hero => Angles { around: 24.0, up: 24.0 },
        }
    }

    /// Sphere that fills the picture, around what is seen of a mesh in one.
    pub(crate) fn framed(self, mesh: &BoundingSphere) -> BoundingSphere {
        match self {
            Self::Studio => *mesh,
            // With room for the shadow before it.
            Self::Hero => BoundingSphere {
                centre_mm: mesh.centre_mm - 0.12 * mesh.radius_mm * Vec3::Y,
                radius_mm: 1.18 * mesh.radius_mm,
            },
        }
    }

    /// What is drawn of a mesh that stands in the set: the mesh, with its ground if the set has any. Where the mesh has texture
    /// coordinates, the ground has them as large as they are on the mesh on average.
    #[must_use]
    pub fn with_ground(self, mesh: &Mesh) -> Cow<'_, Mesh> {
        if self == Self::Studio {
            return Cow::Borrowed(mesh);
        }
        let bounds = mesh.bounding_sphere();
        let [low, _] = mesh.bounds();
        let below = Vec3::new(bounds.centre_mm.x, low.y + SUNK * bounds.radius_mm, bounds.centre_mm.z);
        let mut ground = plate(PLATE * bounds.radius_mm, PLATE_THICKNESS * bounds.radius_mm, PLATE_RINGS);
        ground.uvs = mesh.mm_per_uv().map(|mm| {
            // All texture coordinates of a mesh may be one.
            let mm = if mm > 0.0 { mm } else { 1.0 };
            let uv = |position: &Vec3| Vec2::new(position.x, -position.z) / mm;
            ground.positions.iter().map(uv).collect()
        });
        ground.positions.iter_mut().for_each(|position| *position += below);
        Cow::Owned(mesh.clone().with(ground))
    }
}

#[cfg(test)]
mod tests {
    use subsurf_scene::torus;

    use super::*;

    #[test]
    fn the_ground_is_under_the_mesh_and_its_material_as_large() {
        let mesh = torus(18.0, 8.0, 24);
        let whole = Set::Hero.with_ground(&mesh);
        assert!(whole.triangles.len() > mesh.triangles.len() && whole.positions.len() == whole.normals.len(), "both");
        let [low, high] = whole.bounds();
        // The plate lies 0.012 of 26 mm above the lowest point, and is 0.16 of it thick.
        assert!((low.y + 8.0 - (0.012 - 0.16) * 26.0).abs() < 1e-3, "{low}");
        assert!((high.y - 8.0).abs() < 1e-3 && (high.x - 2.1 * 26.0).abs() < 1e-2, "{high}");
        let [alone, both] = [&mesh, whole.as_ref()].map(|mesh| mesh.mm_per_uv().unwrap());
        assert!((both / alone - 1.0).abs() < 0.05, "{both} mm to a unit of the texture, {alone} of the mesh alone");
        let one = Mesh { uvs: Some(vec![Vec2::ONE; mesh.positions.len()]), ..mesh.clone() };
        assert!(
            Set::Hero.with_ground(&one).uvs.iter().flatten().all(|uv| uv.is_finite()),
            "one texture coordinate for all"
        );
        let bare = Mesh { uvs: None, ..mesh.clone() }.charted();
        let whole = Set::Hero.with_ground(&bare);
        assert_eq!(whole.sides().len(), whole.positions.len(), "charts of the mesh, and the ground by its normals");
        assert!(matches!(Set::Studio.with_ground(&mesh), Cow::Borrowed(_)), "nothing else");
    }
}
