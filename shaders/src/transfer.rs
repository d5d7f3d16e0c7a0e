//! Light on a mesh whose scattering is precomputed: what each light of its file stands for.

use std::f32::consts::PI;

use glam::{Mat4, Vec3};
use subsurf_decoder::Transfer;
use subsurf_decoder::container::bytes::F32Le;
use subsurf_decoder::transfer::LightWeights;

use crate::cpu::{Reflections, incident};
use crate::rgb::Rgb;
use crate::uniform::Scene;

/// Roughness of the mirror in which each light of a file sees its part of the environment: of 200 lights each has a circle of 8°.
const SKY_ROUGHNESS: f32 = 0.4;

/// What each channel of a file of one channel is multiplied by, from the reflectance T(0) of its profile; 1 of three channels (`FORMAT.md`,
/// section 7.2).
#[must_use]
pub fn transfer_tint(transfer: &Transfer<'_>) -> Rgb {
    let reflectance = [0, 1, 2].map(|c| transfer.tail().get(c).unwrap_or(0.0));
    let mean = reflectance.iter().sum::<f32>() / 3.0;
    if transfer.header().channels == 1 && mean > 0.0 { reflectance.map(|own| own / mean) } else { [1.0; 3] }
}

/// Light that falls on a mesh, in the mesh's coordinates; linear Rec. 709.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TransferLight {
    /// Unit vector towards each source, and its irradiance on a plane across it.
    sources: Vec<[Vec3; 2]>,
    /// Irradiance of the environment about each light of the file.
    sky: Vec<Vec3>,
}

impl TransferLight {
    /// Light of a scene on a mesh about `centre_mm`, by the lights of its file, `[light][xyz]`.
    ///
    /// Approximate: what shines from a place is taken to be as far and in the same direction for the whole mesh as for its centre. The
    /// environment counts as the lights of the file, each with 1/n of all directions.
    #[must_use]
    pub fn new(
        lights: F32Le<'_>,
        scene: &Scene,
        world_from_mesh: &Mat4,
        centre_mm: Vec3,
        reflections: &Reflections<'_>,
    ) -> Self {
        let sources = (0..scene.lights as usize).map(|light| {
            let (towards, irradiance) = incident(scene, light, centre_mm);
            // The transform is a rotation, whose inverse is its transpose.
            let axes = [0, 1, 2].map(|k| world_from_mesh.col(k).truncate().dot(towards));
            [Vec3::from(axes).normalize_or_zero(), irradiance]
        });
        let directions: Vec<f32> = lights.iter().collect();
        let (directions, _) = directions.as_chunks();
        #[allow(clippy::cast_precision_loss, reason = "a thousand at most")]
        let solid_angle_sr = 4.0 * PI / directions.len().max(1) as f32;
        let sky = directions.iter().map(|direction| {
            let towards = world_from_mesh.transform_vector3(Vec3::from(*direction));
            solid_angle_sr * reflections.radiance(towards, SKY_ROUGHNESS)
        });
        Self { sources: sources.collect(), sky: sky.collect() }
    }

    /// What each light of the file is multiplied by so that all together are this light, for red, green and blue.
    #[must_use]
    pub fn weights(&self, between: &LightWeights<'_>) -> Vec<Rgb> {
        let mut sums = self.sky.clone();
        let mut weights = vec![0.0; sums.len()];
        for [towards, irradiance] in &self.sources {
            between.at((*towards).into(), &mut weights);
            for (sum, weight) in sums.iter_mut().zip(&weights) {
                *sum += *irradiance * *weight;
            }
        }
        sums.into_iter().map(Rgb::from).collect()
    }
}
