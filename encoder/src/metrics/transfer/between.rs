//! Errors in directions between the lights of a file, where it is drawn.

use nalgebra::{DMatrix, DVector};
use subsurf_decoder::Transfer;
use subsurf_decoder::container::bytes::F32Le;
use subsurf_decoder::transfer::LightWeights;
use subsurf_scene::Mesh;

use super::decode;
use super::views::{ImageError, Views};
use crate::error::{Error, Result};
use crate::progress::Progress;
use crate::transfer::{Options, Precomputed, RdTable, fibonacci, precompute};

/// Views, as many as the paper has.
pub(super) const VIEWS: usize = 100;
/// Sides of views in pixels.
pub(super) const SIDE: u16 = 256;
/// Directions between the lights that errors are measured at.
const BETWEEN: usize = 24;

/// Directions between the lights: turned by a number that no spiral of lights has.
pub(super) fn directions() -> Vec<[f32; 3]> {
    fibonacci(BETWEEN).into_iter().map(|[x, y, z]| [y, z, x]).collect()
}

/// Weights of some lights, `[light][xyz]`, for each of `directions`.
///
/// # Errors
/// [`Error::Request`] if two lights are one.
pub(super) fn weights(lights: F32Le<'_>, directions: &[[f32; 3]]) -> Result<Vec<Vec<f32>>> {
    let count = lights.len() / 3;
    let mut buffer = vec![0.0; LightWeights::buffer_len(count)];
    let between = LightWeights::new(lights, &mut buffer)
        .ok_or_else(|| Error::Request("two lights of the file are one: nothing lies between them".to_owned()))?;
    let of = |towards: &[f32; 3]| {
        let mut weights = vec![0.0; count];
        between.at(*towards, &mut weights);
        weights
    };
    Ok(directions.iter().map(of).collect())
}

/// Exact sums on a mesh in directions between the lights, seen in images: what files with any number of lights are judged by.
pub struct Between<'a> {
    mesh: &'a Mesh,
    views: Views,
    truth: Precomputed,
}

impl<'a> Between<'a> {
    /// Sums for a mesh of a profile.
    ///
    /// # Errors
    /// As [`precompute`].
    pub fn new(mesh: &'a Mesh, table: &RdTable, options: &Options, progress: &dyn Progress) -> Result<Self> {
        let truth = precompute(mesh, table, &directions(), options, progress)?;
        Ok(Self { mesh, views: Views::new(mesh, VIEWS, SIDE), truth })
    }

    /// Error of q that is not compressed: what is between the lights is interpolated, that alone.
    ///
    /// # Errors
    /// [`Error::Request`] if two lights are one.
    pub fn interpolation(&self, of: &Precomputed) -> Result<ImageError> {
        let lights: Vec<u8> = of.lights.iter().flatten().flat_map(|value| value.to_le_bytes()).collect();
        let weights = weights(F32Le::new(&lights), &self.truth.lights)?;
        let count = of.light_count();
        Ok(self.error(of, |c| {
            let q = of.q.rows(c * count, count);
            let at_places = |weights: &Vec<f32>| q.tr_mul(&DVector::from_column_slice(weights));
            weights.iter().map(|weights| of_vertices(of, at_places(weights).as_slice())).collect()
        }))
    }

    /// Error of a file that was made from `of`.
    ///
    /// # Errors
    /// [`Error::Request`] if two lights are one.
    pub fn total(&self, file: &Transfer<'_>, of: &Precomputed) -> Result<ImageError> {
        let weights = weights(file.lights(), &self.truth.lights)?;
        let decoded: Vec<Vec<f32>> = weights.iter().map(|weights| decode(file, weights)).collect();
        Ok(self.error(of, |c| {
            decoded.iter().map(|all| all.iter().skip(c).step_by(of.channels).copied().collect()).collect()
        }))
    }

    /// The worst channel's error of values of all vertices, one row for each direction, each channel divided by its largest q.
    fn error(&self, of: &Precomputed, values: impl Fn(usize) -> Vec<Vec<f32>>) -> ImageError {
        let count = of.light_count();
        let of_channel = |c: usize| {
            let scale = 1.0 / of.q.rows(c * count, count).amax().max(f32::MIN_POSITIVE);
            let found = values(c);
            let errors: Vec<[Vec<f32>; 2]> = (0..BETWEEN)
                .map(|k| {
                    let truth: DMatrix<f32> = self.truth.q.rows(c * BETWEEN + k, 1).into_owned();
                    let truth = of_vertices(&self.truth, truth.as_slice());
                    [
                        found[k].iter().map(|value| scale * value.max(0.0)).collect(),
                        truth.iter().map(|value| scale * value).collect(),
                    ]
                })
                .collect();
            self.views.errors(|view| errors[view % BETWEEN].clone(), self.mesh)
        };
        (0..of.channels).map(of_channel).reduce(ImageError::larger).expect("at least one channel")
    }
}

/// Values of all vertices from those of their places.
fn of_vertices(of: &Precomputed, places: &[f32]) -> Vec<f32> {
    of.place_of.iter().map(|place| places[*place as usize]).collect()
}
