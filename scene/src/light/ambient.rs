//! Light from all around that scatters to the vertices of a mesh: more than on flat ground where the mesh is thin or
//! folded, less on tips.

use std::collections::HashMap;

use glam::{IVec3, Vec3};
use rayon::prelude::*;
use subsurf_decoder::{Bssrdf, Kernel};

use super::transfer::AmbientTransfer;
use crate::error::Result;
use crate::mean_profile::MeanProfile;
use crate::mesh::Mesh;

/// Longest edge of the mesh between whose vertices light scatters, in pixels of the material.
const LONGEST_EDGE: f32 = 1.5;

/// Parts of the radius at which a profile is looked up; it is linear between them.
const PARTS: u16 = 4_096;

/// Parts of the radius of a kernel that count as pixels of a material.
const KERNEL_PIXELS: f32 = 16.0;

/// Piece of the surface.
struct Sample {
    position_mm: Vec3,
    /// Mean of unit normals: shorter where the piece is curved, or has two sides.
    normal: Vec3,
    area_mm2: f32,
}

impl AmbientTransfer {
    /// Transfer of every vertex of a mesh made of a material, by its mean profile: Σ R(r) dA / 2π ∫ R(r) r dr, r the
    /// distance in space. Approximate: heterogeneity and occlusion of the light are left out.
    ///
    /// # Errors
    /// [`Error::Mesh`](crate::Error) if the mesh is too large for the material's pixels.
    pub fn of(mesh: &Mesh, material: &Bssrdf<'_>) -> Result<Vec<Self>> {
        let (header, profile) = (material.header(), MeanProfile::of(material));
        Self::of_profile(mesh, header.pitch_mm, header.r_max_mm, |r_mm| profile.at(r_mm))
    }

    /// The same for a homogeneous material, by the profile of its kernel.
    ///
    /// # Errors
    /// [`Error::Mesh`](crate::Error) if the mesh is too large for the radius of the kernel.
    pub fn of_kernel(mesh: &Mesh, kernel: &Kernel<'_>) -> Result<Vec<Self>> {
        let radius_mm = kernel.header().radius_mm;
        // Profiles rise steeply towards 0: what is nearer than vertices are to each other has one value.
        let pixel_mm = radius_mm / KERNEL_PIXELS;
        let (all, beyond) = (kernel.reflectance(), kernel.tail_at(pixel_mm));
        let within = [0, 1, 2].map(|c| (all[c] - beyond[c]) / (std::f32::consts::PI * pixel_mm * pixel_mm));
        let profile = |r_mm: f32| if r_mm < pixel_mm { within } else { kernel.rd(r_mm) };
        Self::of_profile(mesh, pixel_mm, radius_mm, profile)
    }

    /// Transfer by a profile in mm⁻² that ends at `r_max_mm`, between vertices about a pixel of `pitch_mm` apart.
    fn of_profile(
        mesh: &Mesh,
        pitch_mm: f32,
        r_max_mm: f32,
        profile: impl Fn(f32) -> [f32; 3] + Sync,
    ) -> Result<Vec<Self>> {
        let samples = samples(&mesh.clone().subdivided(LONGEST_EDGE * pitch_mm)?, pitch_mm);
        let cell_mm = 0.5 * r_max_mm;
        let cell_of = |position: Vec3| (position / cell_mm).floor().as_ivec3();
        let mut cells: HashMap<IVec3, Vec<usize>> = HashMap::new();
        for (number, sample) in samples.iter().enumerate() {
            cells.entry(cell_of(sample.position_mm)).or_default().push(number);
        }
        let profile = Profile::new(profile, r_max_mm);
        let flat = profile.flat();
        let share = |(position, normal): (&Vec3, &Vec3)| {
            let [mut front, mut back] = [[0.0; 3]; 2];
            let cell = cell_of(*position);
            for (x, y, z) in around(2) {
                for &number in cells.get(&(cell + IVec3::new(x, y, z))).into_iter().flatten() {
                    let sample = &samples[number];
                    let r_mm = sample.position_mm.distance(*position);
                    if r_mm < r_max_mm {
                        // The share that is exact for light that is the same all around, and for light that rises along the normal.
                        let of_front = 0.5 + 0.5 * sample.normal.dot(*normal);
                        let reflectance = profile.at(r_mm);
                        for c in 0..3 {
                            let scattered = reflectance[c] * sample.area_mm2 / flat[c];
                            front[c] += of_front * scattered;
                            back[c] += (1.0 - of_front) * scattered;
                        }
                    }
                }
            }
            Self { front, back }
        };
        Ok(mesh.positions.par_iter().zip(&mesh.normals).map(share).collect())
    }
}

/// Pieces of the surface in cubes, with a third of the area of the triangles around each of their vertices: all of them count, for sums
/// over every n-th would be noise where triangles are of many sizes.
fn samples(mesh: &Mesh, edge_mm: f32) -> Vec<Sample> {
    let mut numbers: HashMap<IVec3, usize> = HashMap::new();
    let mut samples: Vec<Sample> = Vec::new();
    for ((position, normal), area_mm2) in mesh.positions.iter().zip(&mesh.normals).zip(mesh.vertex_areas()) {
        let number = *numbers.entry((position / edge_mm).floor().as_ivec3()).or_insert(samples.len());
        if number == samples.len() {
            samples.push(Sample { position_mm: Vec3::ZERO, normal: Vec3::ZERO, area_mm2: 0.0 });
        }
        let sample = &mut samples[number];
        sample.position_mm += area_mm2 * position;
        sample.normal += area_mm2 * normal;
        sample.area_mm2 += area_mm2;
    }
    for sample in &mut samples {
        let area_mm2 = sample.area_mm2.max(1e-30);
        sample.position_mm /= area_mm2;
        sample.normal /= area_mm2;
    }
    samples
}

/// Table of a profile R(r) in mm⁻², linear Rec. 709, at equal steps of r: a mesh asks for millions of values.
struct Profile {
    nodes: Vec<[f32; 3]>,
    step_mm: f32,
}

impl Profile {
    fn new(profile: impl Fn(f32) -> [f32; 3], r_max_mm: f32) -> Self {
        let step_mm = r_max_mm / f32::from(PARTS);
        // The last is where the profile ends, not 0: the one before leads there.
        let nodes = (0..=PARTS).map(|k| profile((f32::from(k) * step_mm).min(r_max_mm))).collect();
        Self { nodes, step_mm }
    }

    /// Value at 0 ≤ r < r_max.
    fn at(&self, r_mm: f32) -> [f32; 3] {
        let position = r_mm / self.step_mm;
        #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "within the nodes")]
        let k = (position as usize).min(self.nodes.len() - 2);
        #[allow(clippy::cast_precision_loss, reason = "few nodes")]
        let w = position - k as f32;
        let [low, high] = [&self.nodes[k], &self.nodes[k + 1]];
        [0, 1, 2].map(|c| low[c] + w * (high[c] - low[c]))
    }

    /// Exitance of flat ground, 2π ∫ R(r) r dr, by the midpoint rule.
    fn flat(&self) -> [f32; 3] {
        let ring = |k: u16| {
            let r_mm = (f32::from(k) + 0.5) * self.step_mm;
            self.at(r_mm).map(|value| value * std::f32::consts::TAU * r_mm * self.step_mm)
        };
        (0..PARTS).map(ring).fold([1e-12; 3], |sum, ring| [0, 1, 2].map(|c| sum[c] + ring[c]))
    }
}

/// Steps to the cells at most `reach` away along each axis.
fn around(reach: i32) -> impl Iterator<Item = (i32, i32, i32)> {
    let line = move || -reach..=reach;
    line().flat_map(move |z| line().flat_map(move |y| line().map(move |x| (x, y, z))))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::sphere;

    const REACH_MM: f32 = 8.0;

    fn transfer(mesh: &Mesh) -> Vec<AmbientTransfer> {
        AmbientTransfer::of_profile(mesh, 0.5, REACH_MM, |r_mm| [1.0, 0.5, 0.3].map(|k: f32| (-k * r_mm).exp()))
            .unwrap()
    }

    #[test]
    fn light_that_rises_along_the_normal_scatters_as_its_sum_over_the_surface() {
        // On a ball what is summed up over normals lies along the normal, by symmetry.
        let ball = sphere(2.0, 48);
        let [front, back] =
            [0, 1].map(|side| transfer(&ball).iter().map(|t| [t.front, t.back][side]).collect::<Vec<_>>());
        let areas = ball.vertex_areas();
        let profile = Profile::new(|r_mm| [1.0, 0.5, 0.3].map(|k: f32| (-k * r_mm).exp()), REACH_MM);
        for o in [0, ball.positions.len() / 3, ball.positions.len() / 2] {
            for (c, flat) in profile.flat().into_iter().enumerate() {
                let at = |i: usize| profile.at(ball.positions[o].distance(ball.positions[i]))[c] * areas[i] / flat;
                let even: f32 = (0..areas.len()).map(at).sum();
                let rising: f32 = (0..areas.len()).map(|i| at(i) * ball.normals[i].dot(ball.normals[o])).sum();
                let [sum, difference] = [front[o][c] + back[o][c], front[o][c] - back[o][c]];
                assert!((sum / even - 1.0).abs() < 0.03, "{sum} of {even}");
                assert!((difference - rising).abs() < 0.03 * even, "{difference} of {rising}");
            }
        }
    }

    #[test]
    fn all_of_a_mesh_counts_however_fine_parts_of_it_are() {
        let coarse = sphere(2.0, 32);
        // Eight times as many vertices where x > 0, and among them those that the coarse one has, first.
        let mut fine = coarse.clone();
        let far = |triangle: &[u32; 3]| triangle.iter().any(|&k| coarse.positions[k as usize].x <= 0.0);
        let [kept, mut dense] = [true, false].map(|is_far| Mesh {
            triangles: coarse.triangles.iter().filter(|triangle| far(triangle) == is_far).copied().collect(),
            ..coarse.clone()
        });
        dense = dense.subdivided(0.1).unwrap();
        fine.positions = dense.positions;
        fine.normals = dense.normals;
        fine.uvs = dense.uvs;
        fine.triangles = [kept.triangles, dense.triangles].concat();
        let [coarse_sums, fine_sums] = [transfer(&coarse), transfer(&fine)];
        for (k, (a, b)) in coarse_sums.iter().zip(&fine_sums).enumerate() {
            let [a, b] = [a, b].map(|t| t.front[0] + t.back[0]);
            assert!((a / b - 1.0).abs() < 0.06, "vertex {k}: {a}, {b} of finer triangles");
        }
    }
}
