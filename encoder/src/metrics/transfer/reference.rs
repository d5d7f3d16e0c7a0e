//! What schemes are measured against: q that is not compressed, and exact sums between the lights.

use nalgebra::DMatrix;
use subsurf_decoder::container::bytes::F32Le;
use subsurf_decoder::transfer::LightWeights;
use subsurf_scene::Mesh;

use super::views::{ImageError, Views};
use crate::error::{Error, Result};
use crate::math::parallel;
use crate::progress::Progress;
use crate::transfer::{Options, Precomputed, RdTable, Scheme, fibonacci, precompute};

/// Directions between the lights that errors are measured at.
const BETWEEN: usize = 24;

/// q of one channel of a mesh, divided by the largest for a light of the file: of the lights, and exact between them.
pub struct Reference<'a> {
    mesh: &'a Mesh,
    views: &'a Views,
    /// `[light × vertex]`.
    q: DMatrix<f32>,
    /// `[direction][vertex]`, for [`between`].
    exact: Vec<Vec<f32>>,
    largest: f32,
}

/// Unit directions between those of all spirals of lights, at which errors are measured.
#[must_use]
pub fn between() -> Vec<[f32; 3]> {
    fibonacci(BETWEEN).into_iter().map(|[x, y, z]| [y, z, x]).collect()
}

/// Weights `[direction][light]` by radial basis functions, as the reader of files has them.
///
/// # Errors
/// [`Error::Request`] if two lights are one.
pub fn radial_weights(lights: &[[f32; 3]], directions: &[[f32; 3]]) -> Result<Vec<Vec<f32>>> {
    let bytes: Vec<u8> = lights.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
    let mut buffer = vec![0.0; LightWeights::buffer_len(lights.len())];
    let weights = LightWeights::new(F32Le::new(&bytes), &mut buffer).ok_or_else(|| {
        Error::Request(
            "two lights of the file are one: it is damaged; make it again with `subsurf transfer`".to_owned(),
        )
    })?;
    let of = |towards: &[f32; 3]| {
        let mut out = vec![0.0; lights.len()];
        weights.at(*towards, &mut out);
        out
    };
    Ok(directions.iter().map(of).collect())
}

/// q for lights and then for the directions [`between`] them, for [`Reference::new`].
///
/// # Errors
/// As of [`precompute`].
pub fn precompute_with_between(
    mesh: &Mesh,
    table: &RdTable,
    lights: &[[f32; 3]],
    options: &Options,
    progress: &dyn Progress,
) -> Result<Precomputed> {
    precompute(mesh, table, &[lights, &between()].concat(), options, progress)
}

impl<'a> Reference<'a> {
    /// Channel `c` of what [`precompute_with_between`] gives, seen in `views` of `mesh`.
    ///
    /// # Panics
    /// If it is not from there, and has fewer lights.
    #[must_use]
    pub fn new(mesh: &'a Mesh, views: &'a Views, all: &Precomputed, c: usize) -> Self {
        let (rows, lights) = (all.light_count(), all.light_count() - BETWEEN);
        let of_channel = all.q.rows(c * rows, lights);
        let largest = of_channel.amax().max(f32::MIN_POSITIVE);
        let places: Vec<usize> = all.place_of.iter().map(|place| *place as usize).collect();
        let exact = |k: usize| {
            let row = all.q.row(c * rows + lights + k);
            places.iter().map(|place| row[*place] / largest).collect()
        };
        Self {
            mesh,
            views,
            q: of_channel.select_columns(&places) / largest,
            exact: (0..BETWEEN).map(exact).collect(),
            largest,
        }
    }

    /// q `[light × vertex]`, divided by its largest value.
    #[must_use]
    pub fn q(&self) -> &DMatrix<f32> {
        &self.q
    }

    /// What q was divided by.
    #[must_use]
    pub fn largest(&self) -> f32 {
        self.largest
    }

    /// Root-mean-square error of q, over vertices and lights.
    pub fn q_error(&self, scheme: &dyn Scheme) -> f64 {
        let lights = self.q.nrows();
        let square = |light: usize| {
            let mut weights = vec![0.0; lights];
            weights[light] = 1.0;
            let found = scheme.exitance(&weights);
            found.iter().zip(self.q.row(light).iter()).map(|(a, b)| f64::from(a.max(0.0) - b).powi(2)).sum::<f64>()
        };
        let squares = parallel::map(lights, square);
        (squares.iter().sum::<f64>() / self.q.len() as f64).sqrt()
    }

    /// Errors in images against what is not compressed, with the same weights `[direction][light]`.
    pub fn compression(&self, scheme: &dyn Scheme, weights: &[Vec<f32>]) -> ImageError {
        self.views.errors(self.mesh, &images(scheme, weights), &images(&self.q, weights))
    }

    /// Errors in images against exact sums, with weights for [`between`]: those of compression and of interpolation together.
    pub fn total(&self, scheme: &dyn Scheme, weights: &[Vec<f32>]) -> ImageError {
        self.views.errors(self.mesh, &images(scheme, weights), &self.exact)
    }
}

/// Values of vertices `[direction][vertex]`; below 0 there is no light.
fn images(scheme: &dyn Scheme, weights: &[Vec<f32>]) -> Vec<Vec<f32>> {
    parallel::map(weights.len(), |image| {
        let mut values = scheme.exitance(&weights[image]);
        values.iter_mut().for_each(|value| *value = value.max(0.0));
        values
    })
}
