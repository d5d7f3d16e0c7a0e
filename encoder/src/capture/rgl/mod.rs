//! Isotropic BRDFs of the RGL material database of EPFL, in RGB (Dupuy and Jakob 2018, "An adaptive parameterization for
//! efficient material acquisition and rendering").
//!
//! A `.bsdf` file holds arrays ([`tensor`]) of f32 over slices, which are angles of incidence θ_i, and of 1 byte:
//!
//! | name | shape | |
//! |---|---|---|
//! | `phi_i` | 1 | azimuth of incidence; anisotropic files have more than two |
//! | `theta_i` | slices | angles of incidence in radians, growing |
//! | `ndf`, `sigma` | any × nodes | microfacets D(θ_h), and their projected area σ(θ_i), at u = √(2 θ / π) from 0 to 1 |
//! | `vndf` | 1 × slices × y × x | density of visible microfacets over u_φ (y) and u_θ (x): [`warp`] |
//! | `rgb` | 1 × slices × 3 × y × x | what was measured, over the square that the density is warped to |
//! | `jacobian` | 1 | whether `rgb` still is to be multiplied by D / 4σ |

mod parse;
mod source;
mod tensor;
mod warp;

use std::f64::consts::{PI, TAU};
use std::fs::File;
use std::io::Read;
use std::path::{Path, PathBuf};

use glam::{DVec2, DVec3, Vec3};

use crate::error::{Error, Result};
use parse::parse;
use warp::{Density, Mixture, node};

/// Most bytes of a file: isotropic ones have less than a megabyte.
const MOST_BYTES: u64 = 1 << 26;

/// A measured isotropic BRDF.
///
/// Directions are unit vectors in a frame whose z is the normal. Beyond the last angle of incidence that was measured
/// (the last but one of the file, about 79°), and for grazing directions, values are extrapolated by the database.
#[derive(Debug)]
pub struct Rgl {
    path: PathBuf,
    file_bytes: u64,
    /// Angles of incidence of the slices, in radians.
    theta_i: Vec<f64>,
    /// D and σ at nodes of u.
    microfacets: Vec<f64>,
    area: Vec<f64>,
    densities: Vec<Density>,
    /// Nodes of x and y of what was measured.
    size: [usize; 2],
    /// `[slice][channel][y][x]`.
    rgb: Vec<f32>,
    has_jacobian: bool,
}

impl Rgl {
    /// Reads a `.bsdf` file of RGB and one azimuth of incidence.
    ///
    /// # Errors
    /// [`Error::Input`] if it is another file, cut, spectral, anisotropic, or has numbers that make no sense.
    pub fn open(path: &Path) -> Result<Self> {
        let unreadable = |error| Error::input(path, error, "a measured BRDF (.bsdf) that can be read");
        let mut file = Vec::new();
        File::open(path).and_then(|opened| opened.take(MOST_BYTES + 1).read_to_end(&mut file)).map_err(unreadable)?;
        if file.len() as u64 > MOST_BYTES {
            return Err(Error::input(path, "more than 67 MB", "an isotropic BRDF in RGB, which has about one"));
        }
        parse(path, &file)
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// f_r in sr⁻¹, linear RGB, not negative; zero below the horizon. The light takes the file's direction of incidence.
    #[must_use]
    #[allow(clippy::cast_possible_truncation, reason = "callers want floats")]
    pub fn eval(&self, light: Vec3, view: Vec3) -> [f32; 3] {
        let cosine = self.eval_cosine(light.as_dvec3(), view.as_dvec3());
        cosine.map(|value| if value > 0.0 { (value / f64::from(view.z)) as f32 } else { 0.0 })
    }

    /// f_r · cos θ_o in sr⁻¹, linear RGB; zero below the horizon, and negative where the measurement is. It is what files have: finite and smooth
    /// up to where the exitant direction reaches the horizon.
    fn eval_cosine(&self, incident: DVec3, exitant: DVec3) -> [f64; 3] {
        if incident.z <= 0.0 || exitant.z <= 0.0 {
            return [0.0; 3];
        }
        let (incident, exitant) = (incident.normalize(), exitant.normalize());
        let half = (incident + exitant).normalize();
        let (theta_i, theta_h) = (from_normal(incident), from_normal(half));
        let turns = (azimuth(half) - azimuth(incident) + PI) / TAU;
        let place = [coordinate(theta_h), turns - turns.floor()];

        // Slices around θ_i, and where the density between them takes the half vector.
        let last = self.theta_i.len() - 2;
        let slice = self.theta_i.iter().take(last + 1).rposition(|theta| *theta <= theta_i).unwrap_or(0);
        let [low, high] = [self.theta_i[slice], self.theta_i[slice + 1]];
        let share = ((theta_i - low) / (high - low)).clamp(0.0, 1.0);
        let mixture = Mixture { of: [&self.densities[slice], &self.densities[slice + 1]], share };
        let [x, y] = mixture.cumulative(place);

        // s D / 4σ.
        let jacobian = if self.has_jacobian {
            let area = linear(&self.area, coordinate(theta_i));
            if area > 0.0 { linear(&self.microfacets, coordinate(theta_h)) / (4.0 * area) } else { 0.0 }
        } else {
            1.0
        };
        [0, 1, 2].map(|channel| {
            let of = |slice: usize| self.measured(slice, channel, [x, y]);
            ((1.0 - share) * of(slice) + share * of(slice + 1)) * jacobian
        })
    }

    /// A channel of a slice at a place in the unit square.
    fn measured(&self, slice: usize, channel: usize, place: [f64; 2]) -> f64 {
        let [width, height] = self.size;
        let ((x, fx), (y, fy)) = (node(place[0], width), node(place[1], height));
        let start = (slice * 3 + channel) * width * height;
        let at = |x: usize, y: usize| f64::from(self.rgb[start + y * width + x]);
        let row = |y: usize| (1.0 - fx) * at(x, y) + fx * at(x + 1, y);
        (1.0 - fy) * row(y) + fy * row(y + 1)
    }
}

/// Angle from the normal of a unit vector; exact near it, where the arc cosine is not.
fn from_normal(direction: DVec3) -> f64 {
    2.0 * (0.5 * direction.distance(DVec3::Z)).min(1.0).asin()
}

fn azimuth(direction: DVec3) -> f64 {
    DVec2::new(direction.x, direction.y).to_angle()
}

/// u = √(2 θ / π), 0 to 1 above the horizon.
fn coordinate(theta: f64) -> f64 {
    (2.0 * theta / PI).sqrt().min(1.0)
}

fn linear(table: &[f64], coordinate: f64) -> f64 {
    let (below, share) = node(coordinate, table.len());
    (1.0 - share) * table[below] + share * table[below + 1]
}
