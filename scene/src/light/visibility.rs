//! Vertices that lights reach: a ray from each, by a bounding volume hierarchy.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use bvh::ray::Ray;
use glam::Vec3;
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use super::source::{Light, MAX_LIGHTS, Shadow};
use crate::mesh::Mesh;

/// Triangle of the hierarchy.
struct Triangle {
    corners: [Point3<f32>; 3],
    node: usize,
}

impl Bounded<f32, 3> for Triangle {
    fn aabb(&self) -> Aabb<f32, 3> {
        self.corners.iter().fold(Aabb::empty(), |aabb, corner| aabb.grow(corner))
    }
}

impl BHShape<f32, 3> for Triangle {
    fn set_bh_node_index(&mut self, index: usize) {
        self.node = index;
    }

    fn bh_node_index(&self) -> usize {
        self.node
    }
}

/// Height above its vertex at which a ray starts, as a share of the mesh's longest side: the triangles around the vertex must
/// not shade it.
const OFFSET: f32 = 2e-3;

/// A mesh that may be in the way of the light on itself.
pub struct Occluder {
    triangles: Vec<Triangle>,
    bvh: Bvh<f32, 3>,
    offset_mm: f32,
}

impl Occluder {
    /// Hierarchy of the triangles of a mesh.
    #[must_use]
    pub fn new(mesh: &Mesh) -> Self {
        let corners = |triangle: &[u32; 3]| triangle.map(|k| point(mesh.positions[k as usize]));
        let mut triangles: Vec<Triangle> =
            mesh.triangles.iter().map(|triangle| Triangle { corners: corners(triangle), node: 0 }).collect();
        let bvh = Bvh::build(&mut triangles);
        let [low, high] = mesh.bounds();
        Self { triangles, bvh, offset_mm: OFFSET * (high - low).max_element() }
    }

    /// Whether light reaches a point of the surface from a unit `direction`, from as far as `distance_mm`: nothing of the mesh is
    /// between them. Rays begin a little above the surface, along its unit `normal`.
    #[must_use]
    pub fn is_reached(&self, position_mm: Vec3, normal: Vec3, direction: Vec3, distance_mm: f32) -> bool {
        let start = point(position_mm + self.offset_mm * normal);
        let ray = Ray::new(start, Vector3::new(direction.x, direction.y, direction.z));
        !self.bvh.traverse_iterator(&ray, &self.triangles).any(|triangle| {
            let [a, b, c] = &triangle.corners;
            // Rays meet triangles from either side: meshes are not always wound the same way.
            [ray.intersects_triangle(a, b, c), ray.intersects_triangle(a, c, b)]
                .iter()
                .any(|hit| hit.distance > 0.0 && hit.distance < distance_mm)
        })
    }
}

/// Visibility of lights at every vertex of a mesh: 1 where light number k reaches the vertex, 0 where the mesh itself is in
/// the way or there is no such light.
///
/// Vertices that face away from a light count as reached: they get nothing from it anyway. Lights without shadows reach all.
#[must_use]
pub fn visibility(mesh: &Mesh, lights: &[Light]) -> Vec<[f32; MAX_LIGHTS]> {
    let occluder = Occluder::new(mesh);
    let is_reached = |position: Vec3, normal: Vec3, light: &Light| {
        let (direction, distance) = light.direction_from(position);
        light.shadow == Shadow::None
            || normal.dot(direction) <= 0.0
            || occluder.is_reached(position, normal, direction, distance)
    };
    let of_vertex = |(position, normal): (&Vec3, &Vec3)| {
        let mut of_lights = [0.0; MAX_LIGHTS];
        for (visibility, light) in of_lights.iter_mut().zip(lights) {
            *visibility = f32::from(u8::from(is_reached(*position, *normal, light)));
        }
        of_lights
    };
    mesh.positions.par_iter().zip(&mesh.normals).map(of_vertex).collect()
}

fn point(v: Vec3) -> Point3<f32> {
    Point3::new(v.x, v.y, v.z)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::LightShape;
    use crate::mesh::{sphere, torus};

    fn sun(towards: Vec3) -> Light {
        Light { shape: LightShape::Directional { towards }, irradiance: [1.0; 3], shadow: Shadow::Drawn }
    }

    #[test]
    fn a_sphere_does_not_shade_itself() {
        let ball = sphere(10.0, 16);
        assert!(visibility(&ball, &[sun(Vec3::Y)]).iter().all(|seen| seen[0] == 1.0), "convex");
    }

    #[test]
    fn a_torus_shades_its_far_inner_side() {
        let ring = torus(10.0, 3.0, 16);
        let along = Vec3::new(1.0, 0.05, 0.0).normalize();
        let seen = visibility(&ring, &[sun(along), Light { shadow: Shadow::None, ..sun(along) }]);
        // The inside of the tube at −x faces the light, behind the tube at +x.
        let mut shaded = 0;
        for ((position, normal), [seen, through, ..]) in ring.positions.iter().zip(&ring.normals).zip(&seen) {
            assert_eq!(*through, 1.0, "{position} is reached without shadows");
            let inner = position.x < -5.0 && position.y.abs() < 1.0 && normal.x > 0.9;
            let outer = position.x > 5.0 && normal.x > 0.9;
            assert!(!outer || *seen == 1.0, "{position} is in the light");
            shaded += usize::from(inner && *seen == 0.0);
            assert!(!inner || *seen == 0.0, "{position} is in shadow");
        }
        assert!(shaded > 0, "some vertices lie there");
    }
}
