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
/// Number of vertices to a square pixel of the material that is enough.
const DENSITY: f32 = 1.5;

/// Parts of the radius at which a profile is looked up; it is linear between them.
const PARTS: u16 = 4_096;

/// Parts of the radius of a kernel that count as pixels of a material.
const KERNEL_PIXELS: f32 = 16.0;

/// Vertex that stands for a piece of the surface.
struct Sample {
    position_mm: Vec3,
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
        let samples = samples(mesh.clone().subdivided(LONGEST_EDGE * pitch_mm)?, pitch_mm);
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
                        let sum = if sample.normal.dot(*normal) >= 0.0 { &mut front } else { &mut back };
                        let reflectance = profile.at(r_mm);
                        for c in 0..3 {
                            sum[c] += reflectance[c] * sample.area_mm2 / flat[c];
                        }
                    }
                }
            }
            Self { front, back }
        };
        Ok(mesh.positions.par_iter().zip(&mesh.normals).map(share).collect())
    }
}

/// Vertices with a third of the area of the triangles around each; every n-th with n times the area where they are dense.
fn samples(mesh: Mesh, pitch_mm: f32) -> Vec<Sample> {
    let areas = mesh.vertex_areas();
    let total: f32 = areas.iter().sum();
    #[allow(clippy::cast_precision_loss, reason = "an estimate")]
    let density = areas.len() as f32 * pitch_mm * pitch_mm / total.max(1e-9);
    #[allow(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "clamped")]
    let stride = (density / DENSITY).clamp(1.0, 1e6) as usize;
    let vertices = mesh.positions.iter().zip(&mesh.normals).zip(&areas);
    #[allow(clippy::cast_precision_loss, reason = "small")]
    let sample = |((position_mm, normal), area): ((&Vec3, &Vec3), &f32)| Sample {
        position_mm: *position_mm,
        normal: *normal,
        area_mm2: *area * stride as f32,
    };
    vertices.step_by(stride).map(sample).collect()
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
