//! Isotropic BRDFs as BTFs of one texel, whatever file they are from.

use std::f32::consts::FRAC_PI_2;
use std::path::Path;

use glam::Vec3;

use crate::capture::source::Source;
use crate::error::Result;
use crate::picture::PixelFormat;

/// Views from the normal down, all at azimuth 0.
const VIEWS: u16 = 18;
/// Lights along either axis of the grid: twice the nodes that highlights need.
const LIGHTS: u16 = 91;

/// Directions up to an angle from the normal, unit vectors in a frame whose z is the normal.
pub(super) struct Directions {
    /// Lights, uniform in α and in sin β.
    pub(super) lights: Vec<Vec3>,
    /// Views at azimuth 0, the first along the normal.
    pub(super) views: Vec<Vec3>,
}

impl Directions {
    /// Directions from the normal to `reach_deg`.
    pub(super) fn up_to(reach_deg: f32) -> Self {
        let reach = reach_deg.to_radians();
        let steps = || (0..LIGHTS).map(|k| 2.0 * f32::from(k) / f32::from(LIGHTS - 1) - 1.0);
        let light = |alpha: f32, sin_beta: f32| {
            let ((sin, cos), cos_beta) = ((alpha * FRAC_PI_2).sin_cos(), (1.0 - sin_beta * sin_beta).max(0.0).sqrt());
            Vec3::new(cos_beta * sin, sin_beta, cos_beta * cos)
        };
        let all = steps().flat_map(|alpha| steps().map(move |sin_beta| light(alpha, sin_beta)));
        let view = |number: u16| {
            let theta = f32::from(number) * reach / f32::from(VIEWS - 1);
            Vec3::new(theta.sin(), 0.0, theta.cos())
        };
        Self { lights: all.filter(|light| light.z >= reach.cos()).collect(), views: (0..VIEWS).map(view).collect() }
    }
}

/// Measured isotropic BRDF, which is a source of linear images of one pixel.
pub(super) trait IsotropicBrdf: Sync {
    /// What such a file is, for people.
    const KIND: &str;

    /// The file.
    fn path(&self) -> &Path;
    /// Length of the file.
    fn file_bytes(&self) -> u64;
    /// Directions of the images.
    fn directions(&self) -> &Directions;
    /// π f_r cos θ of the light, linear RGB.
    fn exitance(&self, light: Vec3, view: Vec3) -> [f32; 3];

    /// As [`Source::warnings`].
    fn warnings(&self) -> Vec<String> {
        Vec::new()
    }
}

impl<T: IsotropicBrdf> Source for T {
    fn label(&self) -> String {
        self.path().display().to_string()
    }

    fn kind(&self) -> &'static str {
        T::KIND
    }

    fn lights(&self) -> Vec<Vec3> {
        self.directions().lights.clone()
    }

    fn views(&self) -> Vec<Vec3> {
        self.directions().views.clone()
    }

    fn size(&self) -> [u32; 2] {
        [1, 1]
    }

    fn format(&self) -> PixelFormat {
        PixelFormat::Linear
    }

    fn read(&self, light: usize, view: usize) -> Result<Vec<[f32; 3]>> {
        let Directions { lights, views } = self.directions();
        Ok(vec![self.exitance(lights[light], views[view])])
    }

    fn warnings(&self) -> Vec<String> {
        IsotropicBrdf::warnings(self)
    }

    fn raw_bytes(&self) -> Option<u64> {
        Some(self.file_bytes())
    }
}
