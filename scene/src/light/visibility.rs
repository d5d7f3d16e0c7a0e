//! Which vertices see the light: a ray from each, by a bounding volume hierarchy.

use bvh::aabb::{Aabb, Bounded};
use bvh::bounding_hierarchy::BHShape;
use bvh::bvh::Bvh;
use bvh::ray::Ray;
use glam::Vec3;
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;

use super::source::Light;
use crate::mesh::Mesh;

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

/// A ray starts this share of the mesh's size above its vertex: the triangles around it must not shade it.
const OFFSET: f32 = 2e-3;

/// 1 for every vertex that a light reaches, 0 for those in shadow.
#[must_use]
pub fn visibility(mesh: &Mesh, light: &Light) -> Vec<f32> {
    let point = |v: Vec3| Point3::new(v.x, v.y, v.z);
    let corners = |triangle: &[u32; 3]| triangle.map(|k| point(mesh.positions[k as usize]));
    let mut triangles: Vec<Triangle> =
        mesh.triangles.iter().map(|triangle| Triangle { corners: corners(triangle), node: 0 }).collect();
    let bvh = Bvh::build(&mut triangles);
    let [low, high] = mesh.bounds();
    let offset = OFFSET * (high - low).max_element();
    let sees = |(position, normal): (&Vec3, &Vec3)| {
        let (direction, distance) = light.direction_from(*position);
        // What faces away gets no light anyway.
        if normal.dot(direction) <= 0.0 {
            return 1.0;
        }
        let ray = Ray::new(point(position + offset * normal), Vector3::new(direction.x, direction.y, direction.z));
        let hit = bvh.traverse_iterator(&ray, &triangles).any(|triangle| {
            let [a, b, c] = &triangle.corners;
            // Rays meet triangles from either side: meshes are not always wound the same way.
            [ray.intersects_triangle(a, b, c), ray.intersects_triangle(a, c, b)]
                .iter()
                .any(|hit| hit.distance > 0.0 && hit.distance < distance)
        });
        f32::from(u8::from(!hit))
    };
    mesh.positions.par_iter().zip(&mesh.normals).map(sees).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::light::LightShape;
    use crate::mesh::{sphere, torus};

    fn sun(towards: Vec3) -> Light {
        Light { shape: LightShape::Directional { towards }, irradiance: [1.0; 3] }
    }

    #[test]
    fn a_sphere_does_not_shade_itself() {
        let ball = sphere(10.0, 16);
        assert!(visibility(&ball, &sun(Vec3::Y)).iter().all(|&seen| seen == 1.0), "convex");
    }

    #[test]
    fn a_torus_shades_its_far_inner_side() {
        let ring = torus(10.0, 3.0, 16);
        let along = Vec3::new(1.0, 0.05, 0.0).normalize();
        let seen = visibility(&ring, &sun(along));
        // The inside of the tube at −x faces the light, behind the tube at +x.
        let mut shaded = 0;
        for ((position, normal), seen) in ring.positions.iter().zip(&ring.normals).zip(&seen) {
            let inner = position.x < -5.0 && position.y.abs() < 1.0 && normal.x > 0.9;
            let outer = position.x > 5.0 && normal.x > 0.9;
            assert!(!outer || *seen == 1.0, "{position} is in the light");
            shaded += usize::from(inner && *seen == 0.0);
            assert!(!inner || *seen == 0.0, "{position} is in shadow");
        }
        assert!(shaded > 0, "some vertices lie there");
    }
}
