//! Light from all around that scatters to the vertices of a mesh: more than on flat ground where the mesh is thin or
//! folded, less on tips.

use std::collections::HashMap;

use glam::{IVec2, IVec3, Vec3};
use rayon::prelude::*;
use subsurf_decoder::Bssrdf;
use subsurf_decoder::bssrdf::BssrdfHeader;

use super::transfer::AmbientTransfer;
use crate::error::Result;
use crate::mean_profile::MeanProfile;
use crate::mesh::Mesh;

/// Longest edge of the mesh between whose vertices light scatters, in pixels of the material.
const LONGEST_EDGE: f32 = 1.5;
/// Number of vertices to a square pixel of the material that is enough.
const DENSITY: f32 = 1.5;

/// Vertex that stands for a piece of the surface.
struct Sample {
    position_mm: Vec3,
    normal: Vec3,
    area_mm2: f32,
}

impl AmbientTransfer {
    /// Transfer of every vertex of a mesh made of a material, by its mean profile: Σ R(r) dA by the same of a flat
    /// patch, r the distance in space. Approximate: heterogeneity and occlusion of the light are left out.
    ///
    /// # Errors
    /// [`Error::Mesh`](crate::Error) if the mesh is too large for the material's pixels.
    pub fn of(mesh: &Mesh, material: &Bssrdf<'_>) -> Result<Vec<Self>> {
        let header = material.header();
        let profile = MeanProfile::of(material);
        let samples = samples(mesh.clone().subdivided(LONGEST_EDGE * header.pitch_mm)?, header.pitch_mm);
        let cell_mm = 0.5 * header.r_max_mm;
        let cell_of = |position: Vec3| (position / cell_mm).floor().as_ivec3();
        let mut cells: HashMap<IVec3, Vec<usize>> = HashMap::new();
        for (number, sample) in samples.iter().enumerate() {
            cells.entry(cell_of(sample.position_mm)).or_default().push(number);
        }
        let flat = flat(&profile, header);
        let share = |(position, normal): (&Vec3, &Vec3)| {
            let [mut front, mut back] = [[0.0; 3]; 2];
            let cell = cell_of(*position);
            for (x, y, z) in around(2) {
                for &number in cells.get(&(cell + IVec3::new(x, y, z))).into_iter().flatten() {
                    let sample = &samples[number];
                    let r_mm = sample.position_mm.distance(*position);
                    if r_mm <= header.r_max_mm {
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

/// Exitance of a flat patch, as its pixels sum it: Σ R(r) pitch² over the window. Between vertices the profile is a function of any
/// distance, whose integral is another one.
fn flat(profile: &MeanProfile, header: &BssrdfHeader) -> [f32; 3] {
    let radius = i32::from(header.window_radius);
    let pixels = (-radius..=radius).flat_map(|y| (-radius..=radius).map(move |x| IVec2::new(x, y)));
    let rd = pixels.map(|step| profile.at(step.as_vec2().length() * header.pitch_mm));
    let area_mm2 = header.pitch_mm * header.pitch_mm;
    rd.fold([1e-12; 3], |sum, rd| [0, 1, 2].map(|c| sum[c] + rd[c] * area_mm2))
}

/// Steps to the cells at most `reach` away along each axis.
fn around(reach: i32) -> impl Iterator<Item = (i32, i32, i32)> {
    let line = move || -reach..=reach;
    line().flat_map(move |z| line().flat_map(move |y| line().map(move |x| (x, y, z))))
}
