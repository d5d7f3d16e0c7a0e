//! Measured isotropic BRDFs as BTFs of one texel.

use std::f64::consts::{PI, TAU};
use std::path::Path;
use std::sync::LazyLock;

use glam::{DVec3, Vec3};

use super::Rgl;
use crate::capture::isotropic::{Directions, IsotropicBrdf};

/// Angle from the normal of the lowest lights and views, in degrees: files are extrapolated from 78° on at the latest, and
/// are no longer reciprocal below.
const REACH_DEG: f32 = 75.0;
/// Azimuths over which views along the normal are averaged: files differ there by some percent from one to the next.
const AZIMUTHS: u8 = 8;
/// How far off the normal these are, in radians.
const TILT: f64 = 1e-4;

static DIRECTIONS: LazyLock<Directions> = LazyLock::new(|| Directions::up_to(REACH_DEG));

impl IsotropicBrdf for Rgl {
    const KIND: &str = "isotropic BRDF of RGL";

    fn path(&self) -> &Path {
        self.path()
    }

    fn file_bytes(&self) -> u64 {
        self.file_bytes
    }

    fn directions(&self) -> &Directions {
        &DIRECTIONS
    }

    /// As the BRDF is reciprocal, the view takes the file's direction of incidence: the cosine is then the one that the
    /// file has already.
    #[allow(clippy::cast_possible_truncation, reason = "images are floats")]
    fn exitance(&self, light: Vec3, view: Vec3) -> [f32; 3] {
        let (light, view) = (light.as_dvec3(), view.as_dvec3());
        let value = if view.truncate().length() < TILT {
            let around = (0..AZIMUTHS).map(|k| {
                let (sin, cos) = (TAU * f64::from(k) / f64::from(AZIMUTHS)).sin_cos();
                self.eval_cosine(DVec3::new(TILT * cos, TILT * sin, 1.0), light)
            });
            let sum = around.fold([0.0; 3], |sum, value| [0, 1, 2].map(|c: usize| sum[c] + value[c]));
            sum.map(|value| value / f64::from(AZIMUTHS))
        } else {
            self.eval_cosine(view, light)
        };
        value.map(|value| (PI * value) as f32)
    }
}
