//! Points evenly over a surface, and the triangles between them.

use std::cmp::Reverse;
use std::collections::BinaryHeap;

use glam::Vec3;
use subsurf_scene::Mesh;

use crate::math::parallel;

/// Reference points of a mesh, triangles of them, and where on these the vertices are.
///
/// The paper takes them from a simplified mesh, or one that is tiled anew. Here each point is the vertex that is farthest from those before
/// it, along edges, and triangles lie where three cells of vertices with the same closest point meet (Peyré and Cohen 2006, *Geodesic
/// remeshing using front propagation*).
pub struct Tiling {
    /// Vertices that are reference points.
    pub(super) points: Vec<u32>,
    /// Numbers of the points at the corners, one point three times where there is no triangle.
    pub(super) triangles: Vec<[u32; 3]>,
    /// Triangle of each vertex, and the weights of its corners at the closest point of it.
    pub(super) barycentric: Vec<(u32, [f32; 3])>,
}

impl Tiling {
    /// At most `count` points, at least one; `place_of` has one number for vertices that are in one place.
    #[must_use]
    pub fn new(mesh: &Mesh, place_of: &[u32], count: usize) -> Self {
        let graph = Graph::new(mesh, place_of);
        let (points, owners) = graph.cells(count.max(1));
        let owner = |vertex: u32| owners[graph.first_of[vertex as usize] as usize];
        let mut triangles: Vec<[u32; 3]> = mesh
            .triangles
            .iter()
            .map(|corners| {
                let mut corners = corners.map(owner);
                corners.sort_unstable();
                corners
            })
            .filter(|[a, b, c]| a < b && b < c)
            .collect();
        triangles.sort_unstable();
        triangles.dedup();
        let mut of_point = vec![Vec::new(); points.len()];
        for (number, corners) in (0..).zip(&triangles) {
            corners.iter().for_each(|point| of_point[*point as usize].push(number));
        }
        for (point, around) in (0..).zip(&mut of_point) {
            if around.is_empty() {
                around.push(u32::try_from(triangles.len()).expect("fewer than 2³² triangles"));
                triangles.push([point; 3]);
            }
        }
        let at = |point: u32| mesh.positions[points[point as usize] as usize];
        let barycentric = parallel::map(mesh.positions.len(), |vertex| {
            let (own, position) = (owners[graph.first_of[vertex] as usize], mesh.positions[vertex]);
            let first = of_point[own as usize][0];
            let corner = triangles[first as usize].iter().position(|point| *point == own).unwrap_or(0);
            let mut best = (first, [0, 1, 2].map(|k| if k == corner { 1.0 } else { 0.0 }));
            let mut least = position.distance_squared(at(own));
            for triangle in &of_point[own as usize] {
                let corners = triangles[*triangle as usize].map(at);
                let weights = closest(position, corners);
                let found: Vec3 = (0..3).map(|k| weights[k] * corners[k]).sum();
                if found.distance_squared(position) < least {
                    least = found.distance_squared(position);
                    best = (*triangle, weights);
                }
            }
            best
        });
        Self { points, triangles, barycentric }
    }

    /// Number of points.
    #[must_use]
    pub fn count(&self) -> usize {
        self.points.len()
    }
}

/// Edges of a mesh between the first vertices of all places.
struct Graph {
    /// The first vertex that is where a vertex is.
    first_of: Vec<u32>,
    /// Other ends of edges, and their lengths in mm, `[vertex]`.
    edges: Vec<Vec<(u32, f32)>>,
}

impl Graph {
    fn new(mesh: &Mesh, place_of: &[u32]) -> Self {
        let mut of_place = vec![u32::MAX; place_of.len()];
        let mut first = |(vertex, place): (u32, &u32)| {
            let first = &mut of_place[*place as usize];
            *first = vertex.min(*first);
            *first
        };
        let first_of: Vec<u32> = (0..).zip(place_of).map(&mut first).collect();
        let mut edges = vec![Vec::new(); place_of.len()];
        for corners in &mesh.triangles {
            let corners = corners.map(|vertex| first_of[vertex as usize]);
            for [a, b] in [[0, 1], [1, 2], [2, 0]].map(|ends| ends.map(|k| corners[k])) {
                let length = mesh.positions[a as usize].distance(mesh.positions[b as usize]);
                if a != b {
                    edges[a as usize].push((b, length));
                    edges[b as usize].push((a, length));
                }
            }
        }
        Self { first_of, edges }
    }

    /// Points that are each farthest from those before, and of each vertex the number of the closest.
    fn cells(&self, count: usize) -> (Vec<u32>, Vec<u32>) {
        let (mut points, mut owners) = (Vec::new(), vec![0; self.edges.len()]);
        let mut distances = vec![f32::INFINITY; self.edges.len()];
        // Bits of numbers that are not negative are in their order; of equals the first vertex.
        let key = |vertex: u32, distance: f32| (distance.to_bits(), Reverse(vertex));
        // Vertices without a triangle are nobody's neighbours, and the first point has to do for them.
        let all = (0..).zip(&self.edges).filter(|(_, edges)| !edges.is_empty());
        let mut farthest: BinaryHeap<_> = all.map(|(vertex, _)| key(vertex, f32::INFINITY)).collect();
        while let Some((bits, Reverse(vertex))) = farthest.pop() {
            let distance = distances[vertex as usize];
            if distance.to_bits() != bits {
                // It has come closer since.
                farthest.push(key(vertex, distance));
                continue;
            }
            if distance == 0.0 || points.len() == count {
                break;
            }
            let point = u32::try_from(points.len()).expect("fewer than 2³² points");
            points.push(vertex);
            self.spread(vertex, point, &mut distances, &mut owners);
        }
        if points.is_empty() {
            points.push(0);
        }
        (points, owners)
    }

    /// Makes a point the owner of what is closer to it than to all others (Dijkstra 1959).
    fn spread(&self, from: u32, point: u32, distances: &mut [f32], owners: &mut [u32]) {
        distances[from as usize] = 0.0;
        let mut open = BinaryHeap::from([(Reverse(0.0_f32.to_bits()), from)]);
        while let Some((Reverse(bits), vertex)) = open.pop() {
            let distance = f32::from_bits(bits);
            if distance > distances[vertex as usize] {
                continue;
            }
            owners[vertex as usize] = point;
            for (other, length) in &self.edges[vertex as usize] {
                let next = distance + length;
                if next < distances[*other as usize] {
                    distances[*other as usize] = next;
                    open.push((Reverse(next.to_bits()), *other));
                }
            }
        }
    }
}

/// Barycentric coordinates of the point of a triangle that is closest to `at` (Ericson 2005, *Real-time collision detection*, 5.1.5).
fn closest(at: Vec3, [a, b, c]: [Vec3; 3]) -> [f32; 3] {
    let [ab, ac] = [b - a, c - a];
    let [d1, d2] = [ab, ac].map(|side| side.dot(at - a));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let [d3, d4] = [ab, ac].map(|side| side.dot(at - b));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = d1 / (d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let [d5, d6] = [ab, ac].map(|side| side.dot(at - c));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = d2 / (d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = (d4 - d3) / ((d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let all = va + vb + vc;
    [va / all, vb / all, vc / all]
}

#[cfg(test)]
mod tests {
    use subsurf_scene::{sphere, torus};

    use super::*;

    /// Numbers that vertices share which are in one place.
    fn places(mesh: &Mesh) -> Vec<u32> {
        let all = &mesh.positions;
        let first = |at: &Vec3| all.iter().position(|other| other.distance(*at) < 1e-3).expect("itself");
        let firsts: Vec<usize> = all.iter().map(first).collect();
        let is_first = |vertex: &usize| firsts[*vertex] == *vertex;
        let numbers: Vec<usize> = (0..all.len()).filter(is_first).collect();
        let number = |first: &usize| u32::try_from(numbers.binary_search(first).unwrap()).unwrap();
        firsts.iter().map(number).collect()
    }

    #[test]
    fn points_are_even_and_vertices_are_near_their_triangles() {
        let mesh = torus(6.0, 2.0, 24);
        let place_of = places(&mesh);
        let tiling = Tiling::new(&mesh, &place_of, 120);
        assert_eq!(tiling.count(), 120);
        let at = |point: u32| mesh.positions[tiling.points[point as usize] as usize];
        let nearest =
            |a: u32| (0..120).filter(|b| *b != a).map(|b| at(a).distance(at(b))).fold(f32::INFINITY, f32::min);
        let apart: Vec<f32> = (0..120).map(nearest).collect();
        let [least, most] =
            apart.iter().fold([f32::INFINITY, 0.0_f32], |[least, most], at| [least.min(*at), most.max(*at)]);
        assert!(most < 2.5 * least, "{least} to {most} mm apart");
        // Euler: twice as many triangles as points on a torus, less where four cells meet.
        let whole = tiling.triangles.iter().filter(|[a, b, _]| a != b).count();
        assert!((200..=244).contains(&whole), "{whole} triangles");
        for (vertex, (triangle, weights)) in tiling.barycentric.iter().enumerate() {
            let corners = tiling.triangles[*triangle as usize].map(at);
            let found: Vec3 = (0..3).map(|k| weights[k] * corners[k]).sum();
            assert!(weights.iter().all(|weight| (-1e-5..=1.0 + 1e-5).contains(weight)), "{weights:?}");
            assert!((weights.iter().sum::<f32>() - 1.0).abs() < 1e-5, "{weights:?}");
            let off = found.distance(mesh.positions[vertex]);
            assert!(off < most, "{off} mm");
        }
    }

    #[test]
    fn all_vertices_may_be_points() {
        let mesh = sphere(3.0, 6);
        let place_of = places(&mesh);
        let tiling = Tiling::new(&mesh, &place_of, usize::MAX);
        let places = place_of.iter().max().map_or(0, |last| *last as usize + 1);
        assert_eq!(tiling.count(), places, "a point for each place");
        for (vertex, (triangle, weights)) in tiling.barycentric.iter().enumerate() {
            let corner = weights.iter().position(|weight| *weight > 0.999).expect("on a point");
            let point = tiling.points[tiling.triangles[*triangle as usize][corner] as usize];
            assert_eq!(place_of[point as usize], place_of[vertex]);
        }
    }

    #[test]
    fn the_closest_point_is_at_a_corner_an_edge_or_within() {
        let corners = [Vec3::ZERO, Vec3::X, Vec3::Y];
        let cases = [
            (Vec3::new(-1.0, -1.0, 2.0), [1.0, 0.0, 0.0]),
            (Vec3::new(3.0, 0.5, 0.0), [0.0, 1.0, 0.0]),
            (Vec3::new(0.25, -1.0, 0.0), [0.75, 0.25, 0.0]),
            (Vec3::new(1.0, 1.0, 1.0), [0.0, 0.5, 0.5]),
            (Vec3::new(-2.0, 0.5, 0.0), [0.5, 0.0, 0.5]),
            (Vec3::new(0.25, 0.5, 3.0), [0.25, 0.25, 0.5]),
        ];
        for (at, expected) in cases {
            assert_eq!(closest(at, corners), expected, "{at}");
        }
    }
}
